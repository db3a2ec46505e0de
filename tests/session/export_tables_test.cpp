#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <set>

#include "base/units.h"
#include "session/export.h"
#include "tests/session/synthetic.h"

namespace filum {
namespace export_tables_test {

const Column& column(const Table& table, const std::string& name) {
  for (const Column& candidate : table.columns)
    if (candidate.name == name) return candidate;
  ADD_FAILURE() << "no column " << name;
  return table.columns.front();
}

const Table& table(const std::vector<Table>& tables, const std::string& name) {
  for (const Table& candidate : tables)
    if (candidate.name == name) return candidate;
  ADD_FAILURE() << "no table " << name;
  return tables.front();
}

template <class T>
const std::vector<T>& values(const Table& of, const std::string& name) {
  return std::get<std::vector<T>>(column(of, name).values);
}

class ExportTables : public testing::Test {
 protected:
  void SetUp() override {
    synthetic::write_recording(folder_.file("a"), 200);
    tables_ = recorded_tables(RecordingReader(folder_.file("a")));
  }
  synthetic::Folder folder_;
  std::vector<Table> tables_;
};

TEST_F(ExportTables, InputsAreThoseThatWereRecorded) {
  const Table& inputs = table(tables_, "inputs");
  EXPECT_DOUBLE_EQ(inputs.rate, 500.0);
  const auto& y = values<double>(inputs, "tool1_p_y");
  ASSERT_EQ(y.size(), 200u);
  for (std::size_t i = 0; i < 200; ++i) EXPECT_EQ(y[i], synthetic::step(i + 1).inputs.tools[1].X_WD.p.y());
  EXPECT_EQ(values<std::int64_t>(inputs, "tool0_buttons")[4], 5);
  EXPECT_EQ(values<std::string>(inputs, "state_hash")[0].size(), 16u);
  for (const Column& one : inputs.columns) EXPECT_EQ(one.name.find("tool2"), std::string::npos);
}

TEST_F(ExportTables, WhatADeviceDidNotMeasureIsEmptyNotZero) {
  const Table& samples = table(tables_, "samples");
  const auto& force = values<double>(samples, "grip_force");
  ASSERT_EQ(force.size(), 400u);
  for (std::size_t i = 0; i < force.size(); ++i) {
    const SampleRecord expected = synthetic::sample(i + 2);
    EXPECT_EQ(std::isnan(force[i]), !expected.has_grip_force) << i;
    if (expected.has_grip_force) {
      EXPECT_EQ(force[i], expected.grip_force);
    }
  }
}

TEST_F(ExportTables, EventsHashesAndScoreAreThere) {
  EXPECT_EQ(values<std::string>(table(tables_, "events"), "name"), std::vector<std::string>(20, "grasp"));
  EXPECT_EQ(values<std::string>(table(tables_, "events"), "text")[0], "the jaws hold edge 10");
  EXPECT_EQ(values<std::string>(table(tables_, "array_hashes"), "array").size(), 4u);
  EXPECT_EQ(values<double>(table(tables_, "score"), "total"), std::vector<double>{87.5});
}

TEST_F(ExportTables, SamplesTellTheirRate) {
  // samples 2 to 401, 1 ms apart, in turn from two tools: 199 intervals of 2 ms each
  EXPECT_DOUBLE_EQ(table(tables_, "samples").rate, 500.0);
  for (const double rate : values<double>(table(tables_, "samples"), "rate")) EXPECT_DOUBLE_EQ(rate, 500.0);
}

TEST_F(ExportTables, ToolsOfDifferentRatesEachTellTheirOwn) {
  {
    Recorder recorder(synthetic::options(folder_.file("b")));
    for (int n = 0; n <= 100; ++n) {
      SampleRecord s;
      s.host_time_us = 1000 * n;
      recorder.record_sample(s);
      s.tool = 1;
      if (n % 4 == 0) recorder.record_sample(s);
    }
    ASSERT_TRUE(recorder.close());
  }
  const auto tables = recorded_tables(RecordingReader(folder_.file("b")));
  const Table& samples = table(tables, "samples");
  EXPECT_EQ(samples.rate, 0.0);
  const auto& tool = values<std::int64_t>(samples, "tool");
  for (std::size_t i = 0; i < tool.size(); ++i) EXPECT_DOUBLE_EQ(values<double>(samples, "rate")[i], tool[i] == 0 ? 1000.0 : 250.0);
}

TEST_F(ExportTables, DamagedBlocksAreLeftOutAndTheOthersRead) {
  std::string bytes;
  {
    std::ifstream in(folder_.file("a"), std::ios::binary);
    bytes.assign(std::istreambuf_iterator<char>(in), {});
  }
  const std::size_t at = bytes.find("the jaws hold edge 10");
  ASSERT_NE(at, std::string::npos);
  bytes[at] = 'T';
  std::ofstream(folder_.file("b"), std::ios::binary) << bytes;
  const auto tables = recorded_tables(RecordingReader(folder_.file("b")));
  EXPECT_TRUE(table(tables, "events").columns.empty());
  EXPECT_EQ(values<double>(table(tables, "samples"), "grip_force").size(), 400u);
}

TEST_F(ExportTables, EveryColumnHasItsOwnNameAUnitAndAMeaning) {
  const std::set<std::string> not_si{"us", "points", "see unit"};
  for (const Table& one : tables_) {
    std::set<std::string> names;
    for (const Column& c : one.columns) {
      EXPECT_TRUE(names.insert(c.name).second) << one.name << " " << c.name;
      EXPECT_FALSE(c.meaning.empty()) << c.name;
      if (not_si.contains(c.unit)) continue;
      EXPECT_NO_THROW(dimension_of(c.unit)) << c.unit;
    }
  }
}

}  // namespace export_tables_test
}  // namespace filum
