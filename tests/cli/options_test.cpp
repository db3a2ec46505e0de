#include "cli/options.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "program_call.h"

namespace filum {
namespace options_test {

TEST(Options, TheRootIsThatOfTheSourcesUnlessSaidOtherwise) {
  CLI::App app;
  CommonOptions o;
  add_common(app, o);
  app.parse("", false);
  EXPECT_EQ(o.root, source_folder());
  EXPECT_FALSE(o.json);
  app.parse("--root elsewhere --json", false);
  EXPECT_EQ(o.root, "elsewhere");
  EXPECT_TRUE(o.json);
}

TEST(Options, UnknownOptionsAreRefused) {
  CLI::App app;
  CommonOptions o;
  add_common(app, o);
  EXPECT_THROW(app.parse("--jsn", false), CLI::ParseError);
}

TEST(Options, JsonIsOneLineAndBytesThatAreNoTextDoNotBreakIt) {
  const Ear out;
  print_json(out.stream(), {{"name", "a\xff b"}, {"lines", "1\n2"}});
  const std::string text = out.heard();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1);
  const auto read = nlohmann::json::parse(text);
  EXPECT_EQ(read.at("lines"), "1\n2");
  EXPECT_EQ(read.at("name"), "a\xEF\xBF\xBD b");
}

TEST(Options, TheProgramNamesVersionAndBuild) {
  const std::string text = program_text();
  EXPECT_TRUE(text.starts_with(std::string("filum ") + version()));
  EXPECT_NE(text.find('('), std::string::npos);
}

}  // namespace options_test
}  // namespace filum
