#include "tools/python/keywords.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <map>

#include "scenarios/input/reader.h"
#include "scenarios/input/spelling.h"
#include "tools/python/scenario.h"

namespace lcs::python {
namespace {

using app::Option;
using Kind = Option::Kind;

constexpr const char* kProgress = "progress";
constexpr const char* kProgressType = "collections.abc.Callable[[int, int], object] | None";

/// By `Option::Kind`, in the words of pybind11.
constexpr const char* kTypes[] = {
    "bool",
    "str",
    "os.PathLike",
    "int",
    "float",
    "List[str]",
    "str | os.PathLike[str] | collections.abc.Iterable[str | os.PathLike[str]]",
    "collections.abc.Mapping[str, object]"};

std::string type_of(const Option& option) {
  const std::string type = kTypes[static_cast<std::size_t>(option.kind)];
  if (option.is_optional) return fmt::format("Optional[{}]", type);
  const bool may_be_none = option.kind >= Kind::paths && !option.more.is_required;
  return type + (may_be_none ? " | None" : "");
}

/// The argument that leaves the option at its default.
py::object usual_of(const Option& option) {
  if (option.is_optional || option.kind >= Kind::paths) return py::none();
  const app::Texts words = option.words();
  if (option.kind == Kind::list) return py::cast(words);
  const py::str text(words.empty() ? "" : words.front());
  if (option.kind == Kind::flag) return py::bool_(words.front() == "true");
  if (option.kind == Kind::whole) return py::int_(text);
  if (option.kind == Kind::number) return py::float_(text);
  return text;
}

std::string path_of(const py::handle& path) {
  return py::cast<std::string>(py::module_::import("os").attr("fspath")(path));
}

/// The words that `Option::read` takes.
app::Texts words_of(const Option& option, const py::object& value) {
  switch (option.kind) {
    case Kind::flag:
      return {py::cast<bool>(value) ? "true" : "false"};
    case Kind::text:
    case Kind::path:
      return {path_of(value)};
    case Kind::whole:
      return {py::str(py::module_::import("operator").attr("index")(value))};
    case Kind::number:
      return {input::number_text(py::cast<double>(value))};
    case Kind::settings:
      return assignments_of(value);
    case Kind::list:
      if (py::isinstance<py::str>(value)) throw py::cast_error("a text alone");
      return py::cast<app::Texts>(value);
    case Kind::paths:
      break;
  }
  if (py::isinstance<py::str>(value) || py::hasattr(value, "__fspath__")) return {path_of(value)};
  app::Texts all;
  for (const py::handle path : value) all.push_back(path_of(path));
  return all;
}

/// Sets the option. \throws py::type_error that names the argument, as `Option::read`.
void read(const std::string& function, const Option& option, const py::object& value) {
  const auto wrong = [&](const std::string& why) {
    return py::type_error(fmt::format("{}(): {} is {}: {}", function, option.keyword(),
                                      py::cast<std::string>(py::repr(value)), why));
  };
  app::Texts words;
  try {
    words = words_of(option, value);
  } catch (const py::cast_error&) {
    throw wrong("its type is " + type_of(option));
  } catch (py::error_already_set& error) {
    if (!error.matches(PyExc_TypeError)) throw;
    throw wrong(py::str(error.value()));
  }
  for (const std::string& word : words) option.read(word);
}

}  // namespace

std::string signature_of(const Call& call, const app::Options& options) {
  app::Texts all;
  for (const Option& option : options) {
    if (option.keyword().empty()) continue;
    if (all.size() == call.positional) all.emplace_back("*");
    std::string one = fmt::format("{}: {}", option.keyword(), type_of(option));
    if (!option.more.is_required) {
      one += " = " + py::cast<std::string>(py::repr(usual_of(option)));
    }
    all.push_back(one);
  }
  if (call.takes_progress) all.push_back(fmt::format("{}: {} = None", kProgress, kProgressType));
  return fmt::format("{}({}) -> Answer", options.command, fmt::join(all, ", "));
}

py::object read_arguments(const Call& call, const app::Options& options, const py::args& values,
                          const py::kwargs& named) {
  py::dict given(named);
  app::Texts keywords;
  for (const Option& option : options) {
    if (!option.keyword().empty()) keywords.push_back(option.keyword());
  }
  if (call.takes_progress) keywords.emplace_back(kProgress);
  if (values.size() > call.positional) {
    throw py::type_error(
        fmt::format("{}() takes {} arguments without a name, not {}; name the others, as {}=...",
                    options.command, call.positional, values.size(), keywords.at(call.positional)));
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (given.contains(keywords[i])) {
      throw py::type_error(fmt::format("{}(): {} is given twice", options.command, keywords[i]));
    }
    given[keywords[i].c_str()] = values[i];
  }
  for (const auto& [name, value] : given) {
    const auto keyword = py::cast<std::string>(name);
    if (std::ranges::count(keywords, keyword) > 0) continue;
    throw py::type_error(fmt::format("{}() has no argument '{}'; the nearest is '{}'",
                                     options.command, keyword,
                                     input::nearest_first(keyword, keywords).front()));
  }
  std::map<std::string, std::string> set;  // keywords by the options' names
  for (const Option& option : options) {
    const std::string keyword = option.keyword();
    if (keyword.empty()) continue;
    if (!given.contains(keyword)) {
      if (!option.more.is_required) continue;
      throw py::type_error(fmt::format("{}(): {} is missing", options.command, keyword));
    }
    const py::object value = given[keyword.c_str()];
    if (!option.more.is_required && value.equal(usual_of(option))) continue;
    if (const auto other = set.find(option.more.excludes); other != set.end()) {
      throw py::value_error(
          fmt::format("there are {} and {}; give one of them", other->second, keyword));
    }
    read(options.command, option, value);
    if (!option.name.empty()) set.emplace(option.name, keyword);
  }
  return given.attr("get")(kProgress, py::none());
}

}  // namespace lcs::python
