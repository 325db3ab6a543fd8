// Writes the script that completes command lines of farcull in a shell. The script has tables of
// the words that may follow each command and each option. A function of the script finds the
// command in the line, skips values of options, and reads the tables.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <ranges>

#include "experiments/command/command.h"
#include "experiments/method/options.h"
#include "experiments/scenes/builtin/scenes.h"
#include "experiments/system/output_file.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

std::string joined(const std::vector<std::string>& words, const char* between = " ") {
  return fmt::format("{}", fmt::join(words, between));
}

// Returns the possible values of an option or argument with this DeclaredOption::type, separated by
// blanks. The type may be an enumeration such as "fragment|fixed", or a placeholder such as METHOD,
// SCENE or FILE. Returns @files for any file, @meshes for mesh and scene files, @folders for
// folders. Returns "" for numbers and other types.
std::string completion_words(const std::string& type) {
  for (const Option& option : run_options()) {
    if (type == option.type && !option.words.empty()) return joined(option.words);
  }
  if (type == "AXIS") return "x y z";
  if (type == "SHELL") return "bash";
  if (type == "FILE" || type == "CERTIFICATE" || type == "SHARDS") return "@files";
  if (type == "DIR") return "@folders";
  std::vector<std::string> words;
  if (type != "SCENE" && type != "NAME") {
    if (type.find('|') == std::string::npos) return "";
    for (const auto word : std::views::split(type, '|')) {  // skips placeholders (in capitals)
      const auto capital = [](unsigned char c) { return std::isupper(c) != 0; };
      if (std::ranges::none_of(word, capital)) words.emplace_back(word.begin(), word.end());
    }
    return joined(words);
  }
  for (const BuiltinScene& scene : builtin_scenes()) words.push_back(scene.name);
  if (type == "SCENE") words.emplace_back("@meshes");
  return joined(words);
}

void visit(const DeclaredCommand& command, const std::function<void(const DeclaredCommand&)>& see) {
  see(command);
  for (const DeclaredCommand& below : command.commands) visit(below, see);
}

// Returns one branch per command for `case "$1" in`. A branch sets `below` to the subcommands,
// `flags` to the options, `first` and `others` to values of the first and of later arguments.
std::string table_of_words(const DeclaredCommand& program) {
  std::string out;
  visit(program, [&](const DeclaredCommand& command) {
    std::vector<std::string> commands, options;
    for (const DeclaredCommand& below : command.commands)
      commands.push_back(below.name.substr(below.name.find_last_of(' ') + 1));
    for (const DeclaredOption& option : command.options)
      options.insert(options.end(), option.names.begin(), option.names.end());
    const std::string argument =
        command.arguments.empty() ? "" : completion_words(command.arguments[0].type);
    const std::string last =
        command.arguments.empty() ? "" : completion_words(command.arguments.back().type);
    out += fmt::format("    {})\n      below={} flags={}\n      first={} others={} ;;\n",
                       quoted(command.name), quoted(joined(commands)), quoted(joined(options)),
                       quoted(argument), quoted(last));
  });
  return out;
}

std::string table_of_values(const DeclaredCommand& program) {
  std::string out;
  visit(program, [&](const DeclaredCommand& command) {
    for (const DeclaredOption& option : command.options) {
      if (option.flag) continue;
      std::vector<std::string> patterns;
      for (const std::string& name : option.names)
        patterns.push_back(quoted(command.name + " " + name));
      out += fmt::format("    {}) values={} ;;\n", joined(patterns, " | "),
                         quoted(completion_words(option.type)));
    }
  });
  return out;
}

std::string bash_script(const DeclaredCommand& program) {
  return "# Completion of farcull for bash; made by `farcull completion bash`.\n" +
         fmt::format(
             R"sh(# _farcull_words COMMAND: sets what may follow the command.
_farcull_words() {{
  below='' flags='' first='' others=''
  case $1 in
{}  esac
}}

# _farcull_values "COMMAND OPTION": sets how the value is completed; status 1 where there is none.
_farcull_values() {{
  values=''
  case $1 in
{}    *) return 1 ;;
  esac
}}

# _farcull_read WORDS...: reads the words before the one to complete. Sets `candidates`.
_farcull_read() {{
  local command=farcull pending='' given=0 word below flags first others values
  _farcull_words "$command"
  for word in "$@"; do
    if [[ -n $pending ]]; then
      pending=''
    elif [[ $word == -* ]]; then
      if [[ $word != *=* ]] && _farcull_values "$command $word"; then pending=$word; fi
    elif [[ " $below " == *" $word "* ]]; then
      command="$command $word"
      _farcull_words "$command"
    else
      given=$((given + 1))
    fi
  done
  if [[ -n $pending ]]; then
    _farcull_values "$command $pending"
    candidates=$values
  elif [[ $current == -*=* ]]; then
    _farcull_values "$command ${{current%%=*}}"
    candidates=$values
  elif [[ $current == -* ]]; then
    candidates=$flags
  elif ((given == 0)); then
    candidates="$below $first"
  else
    candidates="$below $others"
  fi
}}
)sh",
             table_of_words(program), table_of_values(program)) +
         R"sh(
_farcull() {
  local current='' candidates='' line=${COMP_LINE:0:COMP_POINT} word prefix='' kind path
  local mesh='\.([oO][bB][jJ]|[oO][fF][fF]|[pP][lL][yY]|[sS][tT][lL]|json|(obj|off|ply|stl)\.gz)$'
  # Bash divides words at = and : as well, so they are put together again.
  local -a words=()
  read -ra words <<<"$line"
  if [[ $line != *[[:space:]] ]]; then
    current=${words[${#words[@]} - 1]}
    unset 'words[${#words[@]}-1]'
  fi
  _farcull_read "${words[@]:1}"
  if [[ $current == -*=* ]]; then current=${current#*=}; fi
  if [[ $current == *[:=]* ]]; then prefix=${current%"${current##*[:=]}"}; fi
  COMPREPLY=()
  for word in $candidates; do
    case $word in
      @files | @folders | @meshes)
        compopt -o filenames 2>/dev/null || :
        kind=f
        if [[ $word == @folders ]]; then kind=d; fi
        while IFS= read -r path; do
          if [[ $word != @meshes || -d $path || $path =~ $mesh ]]; then COMPREPLY+=("$path"); fi
        done < <(compgen "-$kind" -- "$current")
        ;;
      "$current"*) COMPREPLY+=("${word#"$prefix"}") ;;
    esac
  done
}
complete -F _farcull farcull
)sh";
}

class CompletionCommand {
 public:
  CLI::App* add_to(CLI::App& app) {
    program_ = &app;
    return add_command(app, "completion", "what a shell needs to complete farcull's words",
                       {{"SHELL", &shell_, "", "bash", Need::must}},
                       "Examples:\n"
                       "  source <(farcull completion bash)\n\n"
                       "`cmake --install` puts it in place.");
  }
  int run() const {
    if (shell_ != "bash")
      throw Error("SHELL", quoted(shell_) + " is no shell that is known here", "give bash");
    write_help(bash_script(declared(*program_)));
    return 0;
  }

 private:
  const CLI::App* program_ = nullptr;
  std::string shell_;
};

}  // namespace

Command add_completion(CLI::App& app) { return declare<CompletionCommand>(app); }

}  // namespace farcull
