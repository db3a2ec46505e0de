#pragma once
// The program called as a user calls it, in this process: its exit code, and what it said on which stream.

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/program.h"

namespace filum {

/// A stream into memory.
class Ear {
 public:
  Ear() : stream_(::open_memstream(&text_, &size_)) {}
  ~Ear() {
    std::fclose(stream_);
    std::free(text_);
  }
  Ear(const Ear&) = delete;
  Ear& operator=(const Ear&) = delete;
  std::FILE* stream() const { return stream_; }
  std::string heard() const {
    std::fflush(stream_);
    return {text_, size_};
  }

 private:
  char* text_ = nullptr;
  std::size_t size_ = 0;
  std::FILE* stream_;
};

struct Call {
  int code = -1;
  std::string out, err;
  /// What --json printed: one line, nothing else.
  nlohmann::ordered_json json() const {
    EXPECT_EQ(code, kDone) << err;
    EXPECT_EQ(out.find('\n'), out.size() - 1) << out;
    return nlohmann::ordered_json::parse(out);
  }
};

inline Call call(const std::vector<std::string>& words, std::FILE* in = stdin) {
  std::vector<const char*> argv = {"filum"};
  for (const std::string& word : words) argv.push_back(word.c_str());
  const Ear out, err;
  const int code = program(static_cast<int>(argv.size()), argv.data(), {in, out.stream(), err.stream()});
  return {code, out.heard(), err.heard()};
}

/// Bad input: exit code 2, nothing on stdout, and all of `said` (file, field, value, what was expected) on stderr.
inline void expect_refused(const std::vector<std::string>& words, const std::vector<std::string>& said) {
  const Call c = call(words);
  std::string all;
  for (const std::string& word : words) all += " " + word;
  EXPECT_EQ(c.code, kBadInput) << all;
  EXPECT_EQ(c.out, "") << all;
  for (const std::string& text : said) EXPECT_NE(c.err.find(text), std::string::npos) << all << " said: " << c.err << "but not: " << text;
}

inline void expect_keys(const nlohmann::ordered_json& document, const std::vector<const char*>& keys) {
  for (const char* key : keys) EXPECT_TRUE(document.contains(key)) << key << " is not in " << document.dump().substr(0, 400);
}

/// Half a second of a laboratory task by its demonstration, recorded by `filum run`.
inline std::string recorded_run(const std::string& file, const std::string& seconds = "0.5") {
  const Call c = call({"run", "tip-hold", "--input", "demo", "--longest", seconds, "--code", "P01", "--record", file, "--json"});
  EXPECT_EQ(c.code, kDone) << c.err;
  return c.out;
}

}  // namespace filum
