#include "sim/simulation.h"

#include <sys/mman.h>

#include "sim/base/trial.h"
#include "sim/camera/gl_context.h"
#include "sim/observer.h"

namespace lcs::sim {

const scenario::Scenario& require_scene(const scenario::Scenario& scenario) {
  if (!scenario.recording) return scenario;
  throw input::Error(
      scenario.recording->source,
      "these are recorded frames, and there is no world to simulate; give a scenario with a scene");
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

Versions Simulation::versions() const {
  return {mj_versionString(), impl_->gl_renderer()};
}

const Warnings& Simulation::warnings() const {
  return impl_->world().warnings();
}

std::optional<Observation> Simulation::next() {
  if (impl_->next_index() >= impl_->scenario().frames) return std::nullopt;
  return impl_->observe();
}

FrameReadings Simulation::late_readings() const {
  return impl_->late_readings();
}

void Simulation::skip() {
  if (impl_->next_index() < impl_->scenario().frames) impl_->advance();
}

Versions versions() {
  // In a child: once this process has used GL, its children cannot test the memory limit with GL.
  constexpr std::size_t kLongest = 4096;
  void* const shared =
      ::mmap(nullptr, kLongest, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (shared == MAP_FAILED) return {mj_versionString(), GlContext().renderer()};
  const std::unique_ptr<void, void (*)(void*)> owner(shared,
                                                     [](void* at) { ::munmap(at, kLongest); });
  const Trial trial = try_in_child([&] {
    const std::string renderer = GlContext().renderer();
    renderer.copy(static_cast<char*>(shared), kLongest - 1);
  });
  if (!trial.fine) return {mj_versionString(), GlContext().renderer()};  // throws with the reason
  return {mj_versionString(), static_cast<const char*>(shared)};
}

}  // namespace lcs::sim
