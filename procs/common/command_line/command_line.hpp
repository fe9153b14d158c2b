// SPDX-License-Identifier: BSD-3-Clause
// A program's options and subcommands. CLI11 stands behind it, in one file: every file that
// includes its header spends eight seconds of compiling on it.
#pragma once

#include "common/command_line/number_checks.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace waymark {

/// One option of a command, which owns it.
class CommandOption {
 public:
  explicit CommandOption(CLI::Option& option) : option_{&option} {}

  CommandOption required();
  /// The variable's present value shows in --help.
  CommandOption show_default();
  CommandOption check(const NumberCheck& check);
  CommandOption one_of(const std::vector<std::string>& words);
  CommandOption existing_file();
  /// Delimiter between several values in one argument.
  CommandOption delimiter(char between);
  CommandOption needs(CommandOption other);
  CommandOption excludes(CommandOption other);
  bool is_given() const;

 private:
  CLI::Option* option_;
};

/// A subcommand, or the program itself, which owns it.
class Command {
 public:
  explicit Command(CLI::App& app) : app_{&app} {}

  /// @param name  --name, or of an argument by its place: NAME.
  /// @param value  of a type in command_line.cpp; stays as it is when the option is not given.
  template <typename Value>
  CommandOption add_option(const std::string& name, Value& value, const std::string& help);

  /// One of several words, each with what it stands for.
  template <typename Value>
  CommandOption add_choice(const std::string& name, Value& value,
                           const std::vector<std::pair<std::string, Value>>& choices,
                           const std::string& help) {
    std::vector<std::string> words;
    for (const auto& choice : choices)
      words.push_back(choice.first);
    return add_choice(
        name, words,
        [&value, choices](const std::string& chosen) {
          for (const auto& [word, meaning] : choices)
            if (word == chosen) value = meaning;
        },
        help);
  }

  CommandOption add_flag(const std::string& name, bool& value, const std::string& help);
  Command add_subcommand(const std::string& name, const std::string& help);
  /// Options of this command may also follow the subcommand.
  void take_options_of_subcommands();
  /// Passes all remaining arguments on unparsed, --help included.
  void pass_on_the_rest();
  std::vector<std::string> rest() const;
  void when_given(const std::function<void()>& action);
  bool is_given() const;

 protected:
  CommandOption add_choice(const std::string& name, const std::vector<std::string>& words,
                           const std::function<void(const std::string&)>& choose,
                           const std::string& help);

  CLI::App* app_;
};

class Program : public Command {
 public:
  Program(const std::string& purpose, const std::string& name);
  ~Program();

  void require_subcommand();

  /// @return the exit code, when there is nothing more to do: 0 after --help or --version, 2 after
  /// wrong usage, which is explained on standard error.
  std::optional<int> parse(int argc, const char* const* argv);

  /// For what no single option can require. @return the exit code.
  int refuse_without(const std::string& missing);

 private:
  Program(std::unique_ptr<CLI::App> app);

  std::unique_ptr<CLI::App> owned_;
};

}  // namespace waymark
