// filum validate: solves problems with known answers and says how far off each is.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/options.h"
#include "evidence/validation.h"

namespace filum {
namespace {

struct ValidateOptions {
  bool json = false, markdown = false;
  std::vector<std::string> names;
};

nlohmann::ordered_json json_of(const ValidationProblem& p) {
  using Json = nlohmann::ordered_json;
  return {
      {"name", p.name},     {"source", p.source},       {"quantity", p.quantity},
      {"unit", p.unit},     {"expected", p.expected},   {"got", p.got},
      {"error", p.error},   {"tolerance", p.tolerance}, {"order", p.order ? Json(*p.order) : Json(nullptr)},
      {"passed", p.passed}, {"seconds", p.seconds},   {"note", p.note}};
}

void print_line(const ValidationProblem& p, const Streams& io) {
  char order[16] = "";
  if (p.order) std::snprintf(order, sizeof order, "%.2f", *p.order);
  std::fprintf(io.out, "%-4s %-28s %12.6g %12.6g %-6s %9.2e %9.2e %5s %7.2f\n", p.passed ? "ok" : "FAIL",
              p.name.c_str(), p.expected, p.got, p.unit.c_str(), p.error, p.tolerance, order, p.seconds);
  std::fflush(io.out);
}

/// A cell of a Markdown table: a bar in it would end it.
std::string cell(const std::string& text) {
  std::string safe;
  for (const char c : text) (c == '|' ? safe += "\\|" : safe += c);
  return safe;
}

void print_row(const ValidationProblem& p, const Streams& io) {
  const std::string unit = p.unit == "1" ? "" : " " + p.unit;
  std::fprintf(io.out, "| %s: %s | %s | %.6g%s | %.6g%s | %.1e%s | %.2g |\n", cell(p.name).c_str(), cell(p.quantity).c_str(),
              cell(p.source).c_str(), p.expected, unit.c_str(), p.got, unit.c_str(), p.error, p.passed ? "" : ", **missed**", p.tolerance);
  std::fflush(io.out);
}

/// What is told of each problem as soon as it is solved, below a head that is printed at once.
ValidationProgress progress_of(const ValidateOptions& o, const Streams& io) {
  if (o.json) return {};
  if (o.markdown) {
    std::fputs("| problem | source | expected | got | error | tolerance |\n|---|---|---|---|---|---|\n", io.out);
    return [&io](const ValidationProblem& p) { print_row(p, io); };
  }
  std::fprintf(io.out, "%-4s %-28s %12s %12s %-6s %9s %9s %5s %7s\n", "", "problem", "expected", "got", "unit", "error", "tolerance",
              "order", "seconds");
  return [&io](const ValidationProblem& p) { print_line(p, io); };
}

int run(const ValidateOptions& o, const Streams& io) {
  const auto problems = run_validation(o.names, progress_of(o, io));
  const auto failed =
      std::count_if(problems.begin(), problems.end(), [](const ValidationProblem& p) { return !p.passed; });
  if (o.json) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const ValidationProblem& p : problems) list.push_back(json_of(p));
    print_json(io.out, {{"problems", list}});
  } else if (!o.markdown) {
    std::fprintf(io.out, "%zu problems, %td failed\n", problems.size(), failed);
  }
  return failed == 0 ? kDone : kFailed;
}

}  // namespace

void add_validate(CLI::App& app, Action& action) {
  auto o = std::make_shared<ValidateOptions>();
  CLI::App* command =
      app.add_subcommand("validate", "Solve problems with known answers and say how far off each is");
  command->add_option("name", o->names,
                      "Problems to solve, by name or beginning of the name up to a hyphen (default: all)");
  CLI::Option* json = command->add_flag("--json", o->json, "Print one JSON document and nothing else");
  command->add_flag("--markdown", o->markdown, "Print a Markdown table and nothing else")->excludes(json);
  command->callback([o, &action] { action.run = [o](const Streams& io) { return run(*o, io); }; });
}

}  // namespace filum
