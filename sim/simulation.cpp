#include "sim/simulation.h"

#include "sim/gl_context.h"
#include "sim/observer.h"

namespace lcs::sim {

const scenario::Scenario& require_scene(const scenario::Scenario& scenario) {
  if (!scenario.recording) return scenario;
  throw scenario::Error(scenario.recording->source,
                        "these are recorded frames, and there is no world to simulate; give a "
                        "scenario with a scene");
}

struct Simulation::Impl : Observer {
  using Observer::Observer;
};

Simulation::Simulation(const scenario::Scenario& scenario)
    : impl_(std::make_unique<Impl>(require_scene(scenario), WrongStart::refused)) {}
Simulation::~Simulation() = default;

const Calibration& Simulation::calibration() const {
  return impl_->calibration();
}
const std::vector<Object>& Simulation::objects() const {
  return impl_->world().objects();
}
const std::optional<scenario::Origin>& Simulation::origin() const {
  return impl_->world().origin();
}

const Warnings& Simulation::warnings() const {
  return impl_->world().warnings();
}

std::optional<Observation> Simulation::next() {
  if (impl_->next_index() >= impl_->scenario().frames) return std::nullopt;
  return impl_->observe();
}

void Simulation::skip() {
  if (impl_->next_index() < impl_->scenario().frames) impl_->advance();
}

Versions versions() {
  return {mj_versionString(), GlContext().renderer()};
}

}  // namespace lcs::sim
