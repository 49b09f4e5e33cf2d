#include "tools/sequence/script.h"

#include <stdexcept>

#include "scenarios/shipped.h"
#include "tools/input/message.h"
#include "tools/process/python.h"

namespace lcs::sequence {

std::string run_script(const std::string& name, const std::vector<std::string>& arguments) {
  const process::PythonEnd end =
      process::run_python(scenario::shipped_folder("tools/sequence") / name, arguments);
  if (end.is_fine) return end.out;
  throw std::runtime_error(end.err.empty() ? name + " did not come to its end; run it again"
                                           : input::one_line(end.err));
}

}  // namespace lcs::sequence
