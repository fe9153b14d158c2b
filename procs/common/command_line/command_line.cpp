// SPDX-License-Identifier: BSD-3-Clause
#include "common/command_line/command_line.hpp"

#include "common/errors/exit_codes.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>

namespace waymark {

CommandOption CommandOption::required() {
  option_->required();
  return *this;
}

CommandOption CommandOption::show_default() {
  option_->capture_default_str();
  return *this;
}

CommandOption CommandOption::check(const NumberCheck& check) {
  option_->check(
      [check](const std::string& text) -> std::string {
        const double number = std::strtod(text.c_str(), nullptr);
        if (std::isfinite(number) && check.is_good(number)) return {};
        return "got " + text + ", expected " + check.expected;
      },
      check.name);
  return *this;
}

CommandOption CommandOption::one_of(const std::vector<std::string>& words) {
  option_->check(CLI::IsMember(words));
  return *this;
}

CommandOption CommandOption::existing_file() {
  option_->check(CLI::ExistingFile);
  return *this;
}

CommandOption CommandOption::delimiter(char between) {
  option_->delimiter(between);
  return *this;
}

CommandOption CommandOption::needs(CommandOption other) {
  option_->needs(other.option_);
  return *this;
}

CommandOption CommandOption::excludes(CommandOption other) {
  option_->excludes(other.option_);
  return *this;
}

bool CommandOption::is_given() const {
  return option_->count() > 0;
}

template <typename Value>
CommandOption Command::add_option(const std::string& name, Value& value, const std::string& help) {
  return CommandOption{*app_->add_option(name, value, help)};
}

template CommandOption Command::add_option(const std::string&, int&, const std::string&);
template CommandOption Command::add_option(const std::string&, std::uint64_t&, const std::string&);
template CommandOption Command::add_option(const std::string&, double&, const std::string&);
template CommandOption Command::add_option(const std::string&, std::string&, const std::string&);
template CommandOption Command::add_option(const std::string&, std::filesystem::path&,
                                           const std::string&);
template CommandOption Command::add_option(const std::string&, std::optional<std::int64_t>&,
                                           const std::string&);
template CommandOption Command::add_option(const std::string&, std::optional<double>&,
                                           const std::string&);
template CommandOption Command::add_option(const std::string&, std::vector<std::string>&,
                                           const std::string&);
template CommandOption Command::add_option(const std::string&, std::vector<std::filesystem::path>&,
                                           const std::string&);

CommandOption Command::add_choice(const std::string& name, const std::vector<std::string>& words,
                                  const std::function<void(const std::string&)>& choose,
                                  const std::string& help) {
  return CommandOption{*app_->add_option_function(name, choose, help)}.one_of(words);
}

CommandOption Command::add_flag(const std::string& name, bool& value, const std::string& help) {
  return CommandOption{*app_->add_flag(name, value, help)};
}

Command Command::add_subcommand(const std::string& name, const std::string& help) {
  return Command{*app_->add_subcommand(name, help)};
}

void Command::allow_options_after_subcommand() {
  app_->fallthrough();
}

void Command::pass_on_the_rest() {
  app_->set_help_flag();
  app_->prefix_command();
}

std::vector<std::string> Command::rest() const {
  return app_->remaining();
}

void Command::when_given(const std::function<void()>& action) {
  app_->callback(action);
}

bool Command::is_given() const {
  return app_->parsed();
}

Program::Program(const std::string& purpose, const std::string& name)
    : Program{std::make_unique<CLI::App>(purpose, name)} {
  app_->set_version_flag("--version", name + " " WAYMARK_VERSION);
}

Program::Program(std::unique_ptr<CLI::App> app) : Command{*app}, owned_{std::move(app)} {}

Program::~Program() = default;

void Program::require_subcommand() {
  app_->require_subcommand(1);
}

std::optional<int> Program::parse(int argc, const char* const* argv) {
  try {
    app_->parse(argc, argv);
    return std::nullopt;
  } catch (const CLI::RequiredError& error) {
    const std::string unknown = unknown_subcommand();
    if (unknown.empty()) return app_->exit(error) == 0 ? kExitOk : kExitUsage;
    app_->exit(CLI::ExtrasError{unknown, CLI::ExitCodes::ExtrasError});
    return kExitUsage;
  } catch (const CLI::ParseError& error) {
    return app_->exit(error) == 0 ? kExitOk : kExitUsage;
  }
}

/// What is wrong with the word that stands where a subcommand is required; empty without one.
std::string Program::unknown_subcommand() const {
  if (app_->get_require_subcommand_min() == 0 || !app_->get_subcommands().empty()) return {};
  const std::vector<std::string> rest = app_->remaining();
  const auto word = std::ranges::find_if(rest, [](const auto& w) { return !w.starts_with('-'); });
  if (word == rest.end()) return {};
  std::string choices;
  for (const CLI::App* subcommand : app_->get_subcommands([](const CLI::App*) { return true; }))
    choices += (choices.empty() ? "" : ", ") + subcommand->get_name();
  return "there is no command '" + *word + "', expected one of " + choices;
}

int Program::refuse_without(const std::string& missing) {
  app_->exit(CLI::RequiredError{missing});
  return kExitUsage;
}

}  // namespace waymark
