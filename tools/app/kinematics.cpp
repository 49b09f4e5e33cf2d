#include "tools/app/kinematics.h"

#include "scenarios/load.h"
#include "scenarios/scenes.h"
#include "scenarios/shipped.h"
#include "tools/app/how_made.h"
#include "tools/files/output.h"
#include "tools/kinematics/study.h"
#include "tools/suite/suite_run.h"

namespace lcs::app {

KinematicsMade kinematics(const KinematicsRequest& request, Caller& caller) {
  const std::filesystem::path file = request.config.empty()
                                         ? scenario::shipped_folder("scenarios") / "crossing.yaml"
                                         : std::filesystem::path(request.config);
  kinematics::StudyConfig config = kinematics::configure(
      scenario::load(file, {.sets = request.sets, .seed = {}}),
      request.quick ? kinematics::Effort::quick() : kinematics::Effort::full());
  config.tolerance_px = request.tolerance_px;
  caller.warn(scenario::shadowed_files(config.scenario));
  files::ResultNames names = kinematics::study_files();
  names.push_back(files::kHowMadeFile);
  files::Output folder(request.out, names);
  const auto study = [&] {
    const auto progress =
        caller.progress("kinematics", kinematics::study_pieces(config), "experiments");
    int done = 0;
    return kinematics::carry_out(config, [&](int more) {
      caller.check();
      progress->show(done += more);
    });
  }();
  kinematics::write_study(folder.staging(), study);
  files::Json facts{{"scenario", config.scenario.name},
                    {"seed", config.scenario.seed},
                    {"settings", request.sets}};
  add_program(facts, sim::versions());
  write_how_made(folder.staging(), suite::shell_line(arguments_of(request)),
                 files::provenance_of(std::move(facts)));
  caller.check();
  folder.commit();
  std::vector<kinematics::Statement> answer = kinematics::answer(study);
  std::string text = kinematics::text_of(config, answer);
  return {std::move(answer), std::move(text), folder.target()};
}

}  // namespace lcs::app
