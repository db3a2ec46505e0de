// The documents that `filum validate --json` and `filum bench --json` print have the keys that others rely
// on.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

namespace json_test {

struct Printed {
  std::string text;
  int code = -1;
};

Printed run(const std::string& arguments) {
  Printed p;
  FILE* pipe = popen((std::string(FILUM_PROGRAM) + " " + arguments + " 2>/dev/null").c_str(), "r");
  if (pipe == nullptr) return p;
  std::array<char, 4096> buffer;
  for (std::size_t n; (n = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
    p.text.append(buffer.data(), n);
  const int status = pclose(pipe);
  if (WIFEXITED(status)) p.code = WEXITSTATUS(status);
  return p;
}

TEST(EvidenceJson, ValidateHasTheFixedKeys) {
  const Printed p = run("validate --json bending-energy");
  ASSERT_EQ(p.code, 0) << p.text;
  const auto problems = nlohmann::json::parse(p.text).at("problems");
  ASSERT_EQ(problems.size(), 1u);
  for (const char* key : {"name", "source", "quantity", "unit", "expected", "got", "error", "tolerance",
                          "order", "passed", "seconds"})
    EXPECT_TRUE(problems[0].contains(key)) << key;
  EXPECT_TRUE(problems[0]["passed"].is_boolean());
  EXPECT_NEAR(problems[0]["order"].get<double>(), 2.0, 0.1);
}

TEST(EvidenceJson, BenchHasTheFixedKeys) {
  const Printed p = run("bench --json scaling-50");
  ASSERT_EQ(p.code, 0) << p.text;
  const auto document = nlohmann::json::parse(p.text);
  EXPECT_TRUE(document.at("machine").is_string());
  const auto bench = document.at("benches").at(0);
  for (const char* key : {"name", "nodes", "contacts", "dt_ms", "steps", "p50_ms", "p99_ms", "max_ms",
                          "real_time_factor", "stages"})
    EXPECT_TRUE(bench.contains(key)) << key;
  EXPECT_TRUE(bench.at("stages").is_object());
  EXPECT_TRUE(bench.at("reference").contains("name"));
  EXPECT_TRUE(bench.at("reference").contains("p50_ms"));
}

TEST(EvidenceJson, UnknownNamesAreBadInput) {
  EXPECT_EQ(run("validate --json nonsense").code, 2);
  EXPECT_EQ(run("bench --json nonsense").code, 2);
}

}  // namespace json_test
