#include "tools/lcs/command_line.h"

#include <fmt/format.h>
#include <signal.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>

#include "scenarios/input/spelling.h"
#include "tools/app/how_made.h"
#include "tools/lcs/terminal.h"

namespace lcs::tools {
namespace {

/// Help formatter that lists positional arguments only once, not among the options too.
class Help : public CLI::Formatter {
 public:
  std::string make_group(std::string group, bool is_positional,
                         std::vector<const CLI::Option*> options) const override {
    if (!is_positional) {
      std::erase_if(options, [](const CLI::Option* option) { return option->get_positional(); });
    }
    return Formatter::make_group(group, is_positional, options);
  }
};

/// An empty value usually comes from an unset shell variable and must not be treated like an absent
/// option.
std::string complaint_of_empty(const std::string& text) {
  return text.empty() ? "is given without a value; give one, or leave it out" : "";
}

/// The option as a function takes its words. \return the option of the library.
CLI::Option& add_option(CLI::App& command, const app::Option& option) {
  const app::Option::More& more = option.more;
  const std::string names = more.also.empty() ? option.name : more.also + "," + option.name;
  if (more.prints) return *command.set_version_flag(names, more.prints, option.about);
  if (option.kind == app::Option::Kind::flag) {
    const auto set = [&option] { option.read(option.is_negative() ? "false" : "true"); };
    return *command.add_flag_callback(names, set, option.about);
  }
  const auto read = [&option](const app::Texts& words) {
    for (const std::string& word : words) option.read(word);
  };
  CLI::Option& added = *command.add_option_function<app::Texts>(names, read, option.about);
  if (!option.takes_several()) added.expected(1);
  // An option takes one word, so that an argument may follow it.
  added.allow_extra_args(option.is_argument() && option.takes_several());
  return *added.type_name(option.type)->check(complaint_of_empty, "");
}

void add_command(CLI::App& app, const Command& command) {
  CLI::App& added = *app.add_subcommand(command.options.command, command.about);
  std::map<std::string, CLI::Option*> all;
  for (const app::Option& option : command.options) {
    if (option.name.empty()) continue;
    CLI::Option& one = add_option(added, option);
    one.required(option.more.is_required);
    if (option.more.is_output) one.group("Outputs");
    all.emplace(option.name, &one);
  }
  for (const app::Option& option : command.options) {
    const auto& [needs, excludes] = std::pair(option.more.needs, option.more.excludes);
    if (!needs.empty()) all.at(option.name)->needs(all.at(needs));
    if (!excludes.empty()) all.at(option.name)->excludes(all.at(excludes));
  }
  added.footer(command.help);
}

/// The message for a first argument that is no command; "" if it is one, or none is given.
std::string unknown_command(const std::vector<Command>& commands, int argc, char** argv) {
  if (argc < 2 || *argv[1] == '-') return "";
  std::vector<std::string> names;
  for (const Command& command : commands) names.push_back(command.options.command);
  if (std::ranges::find(names, argv[1]) != names.end()) return "";
  const auto near = input::nearest(argv[1], names);
  return fmt::format("there is no command '{}'; {}", argv[1],
                     near ? fmt::format("did you mean '{}'?", *near)
                          : fmt::format("the commands are {}", fmt::join(names, ", ")));
}

}  // namespace

void add_format(app::Options& all, scoring::Format& format) {
  const auto read = [&format](const std::string& word) { format = scoring::format_of(word); };
  all.push_back({"--format", "NAME",
                 "Print only tables: markdown, csv (all digits; KEY_half: half the range or "
                 "interval) or latex (needs booktabs); text, if not given, is for people",
                 app::Option::Kind::text, false, read, [] { return app::Texts{}; }});
}

int fail(const std::string& message) {
  tell(fmt::format("lcs: {}", message));
  return kError;
}

int run_command_line(const std::vector<Command>& commands, std::string_view help, int argc,
                     char** argv) {
  CLI::App app("Test bench for the Line-Circle-Square filter", "lcs");
  app.formatter(std::make_shared<Help>());
  app.set_version_flag(
      "--version", app::version_text,
      "Print the versions of this program (with its commit), MuJoCo, the renderer and OpenCV");
  app.require_subcommand(1);
  app.footer(std::string(help));
  for (const Command& command : commands) add_command(app, command);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help_or_version) {
    ::signal(SIGPIPE, SIG_DFL);  // `lcs --help | head` ends without a word, as other programs do
    return app.exit(help_or_version);
  } catch (const CLI::ExcludesError& error) {
    return fail(fmt::format("{}: the two do not go together; leave one of them out", error.what()));
  } catch (const CLI::RequiresError& error) {
    return fail(fmt::format("{}; give both, or leave the first out", error.what()));
  } catch (const CLI::ParseError& error) {
    if (const std::string unknown = unknown_command(commands, argc, argv); !unknown.empty()) {
      return fail(unknown);
    }
    const auto named = app.get_subcommands();  // the sub-command in use, if any
    const std::string command = named.empty() ? "" : named.front()->get_name() + " ";
    return fail(fmt::format("{}; see lcs {}--help", error.what(), command));
  }
  const std::string name = app.get_subcommands().front()->get_name();
  const auto is_named = [&](const Command& command) { return command.options.command == name; };
  return std::ranges::find_if(commands, is_named)->carry_out();
}

}  // namespace lcs::tools
