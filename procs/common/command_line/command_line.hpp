// SPDX-License-Identifier: BSD-3-Clause
// A program's options and subcommands, by CLI11. Only command_line.cpp includes CLI11, whose header
// takes eight seconds to compile.
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

/// Refers to one option of a command; the command owns the option.
class CommandOption {
 public:
  explicit CommandOption(CLI::Option& option) : option_{&option} {}

  CommandOption required();
  /// --help shows the variable's present value as the default.
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

/// The program itself or a subcommand, which the program owns.
class Command {
 public:
  explicit Command(CLI::App& app) : app_{&app} {}

  /// @param name  "--name" for an option, "NAME" for a positional argument.
  /// @param value  of a type instantiated in command_line.cpp; unchanged when the option is absent.
  template <typename Value>
  CommandOption add_option(const std::string& name, Value& value, const std::string& help);

  /// An option whose value is one of several words, each with the value that it stands for.
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
  /// Options of this command may also come after the subcommand.
  void allow_options_after_subcommand();
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

  /// Reports a missing argument that only some combinations of options require.
  /// @return the exit code, 2.
  int refuse_without(const std::string& missing);

 private:
  Program(std::unique_ptr<CLI::App> app);

  std::string unknown_subcommand() const;

  std::unique_ptr<CLI::App> owned_;
};

}  // namespace waymark
