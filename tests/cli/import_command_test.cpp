// filum import on small tables in the published form: what comes out is a dataset that reconcile reads, in the right units.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <set>
#include <sstream>

#include "program_call.h"
#include "tests/reconcile/records.h"

namespace filum {
namespace import_command_test {

namespace fs = std::filesystem;
using reconcile::Folder;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::string text_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  EXPECT_TRUE(in) << file;
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Header, then what `row` gives for 0 ... n-1.
std::string table(const std::string& header, int n, const std::function<void(std::ostream&, int)>& row) {
  std::ostringstream s;
  s << header << "\n";
  for (int i = 0; i < n; ++i) row(s, i);
  return s.str();
}

/// Stretch (or shear strain) and nominal stress in kPa of four regions.
void write_brain(const Folder& folder) {
  fs::create_directories(folder.file("brain"));
  for (const std::string region : {"cortex", "basal-ganglia", "corona-radiata", "corpus-callosum"}) {
    for (const auto& [mode, sign] : {std::pair{"compression", -1}, {"tension", 1}})
      folder.write("brain/" + region + "_" + mode + ".csv", table("stretch,stress_kPa", 21, [&](std::ostream& s, int i) { s << 1 + sign * 0.005 * i << "," << sign * 0.01 * i << "\n"; }));
    folder.write("brain/" + region + "_shear.csv", table("shear_strain,stress_kPa", 21, [](std::ostream& s, int i) { s << 0.01 * i << "," << 0.007 * i << "\n"; }));
  }
}

/// On a cube of 5 mm, so 25 mm2: 1 kPa is 25 mN, a stretch of 0.9 is -0.5 mm.
TEST(ImportCommand, BrainTablesBecomeForcesAndDisplacementsOfTheirCube) {
  const Folder folder;
  write_brain(folder);
  const Call c = call({"import", "brain-budday2017", folder.file("brain"), "--out", folder.file("sets")});
  EXPECT_EQ(c.code, kDone) << c.err;
  EXPECT_EQ(lines_of(c.out).size(), 4u) << c.out;
  EXPECT_EQ(lines_of(text_of(folder.file("sets/brain-cortex/compression.csv"))).back(), "20,-0.5,-5");
  EXPECT_EQ(lines_of(text_of(folder.file("sets/brain-cortex/shear.csv"))).back(), "20,1,3.5");
  const Call solved = call({"reconcile", folder.file("sets/brain-cortex"), "--out", folder.file("report")});
  EXPECT_EQ(solved.out.find("brain-cortex: "), 0u) << solved.out << solved.err;
}

/// Cauchy stress over stretch is nominal stress: -2 kPa / 0.8 on 25 mm2.
TEST(ImportCommand, MuscleTablesGiveNominalStressAndHoldTheFastestRampOut) {
  const Folder folder;
  fs::create_directories(folder.file("muscle"));
  for (const char* name : {"F", "XF"})
    for (const char* run : {"10", "20", "30", "005", "01", "05"})
      folder.write(std::string("muscle/") + name + "_" + run + ".csv", table("time_s,stretch,stress_kPa", 22, [](std::ostream& s, int i) {
                     const int k = std::min(i, 20);  // the last time stands twice
                     s << k << "," << 1 - 0.01 * k << "," << -0.1 * k << "\n";
                   }));
  EXPECT_EQ(call({"import", "muscle-vanloocke", folder.file("muscle"), "--out", folder.file("sets")}).code, kDone);
  const auto rows = lines_of(text_of(folder.file("sets/muscle-along/run-10.csv")));
  EXPECT_EQ(rows.back(), "20,-1,-62.5");
  EXPECT_EQ(rows.size(), 22u) << "a time that stands twice is left out";
  const std::string experiment = text_of(folder.file("sets/muscle-across/experiment.yaml"));
  const std::string fastest = experiment.substr(experiment.find("run-05.csv"));
  EXPECT_NE(fastest.substr(0, fastest.find('\n')).find("hold_out: true"), std::string::npos) << experiment;
}

void write_cells(const Folder& folder) {
  fs::create_directories(folder.file("cells"));
  for (int cell = 1; cell <= 4; ++cell)
    folder.write("cells/3axisCell" + std::to_string(cell) + "CalibrationData.csv", table("force_x,force_y,force_z,corrected_x,corrected_y,corrected_z", 13, [](std::ostream& s, int n) {
                   int f[3] = {0, 0, 0};
                   f[n == 0 ? 0 : (n - 1) / 4] = n == 0 ? 0 : 100 * ((n - 1) % 4 + 1);
                   s << f[0] << "," << f[1] << "," << f[2] << "," << 1000 * f[0] + 20 * f[1] << "," << 900 * f[1] << "," << 800 * f[2] << "\n";
                 }));
  folder.write("cells/loadingTest.csv", table("n,ms,us,a,b,c", 6000, [](std::ostream& s, int i) {
                 const int on = i / 1000 % 2;
                 s << i << "," << 1000000 + 113 * i << ",0," << 600 - 7000 * on << "," << -700 - 6000 * on << "," << 50 - 5000 * on << "\n";
               }));
}

/// Pairs of axes with the third unloaded; beams: means of forty readings wholly on or off, each time on and off a trial. 100 gram-force is 0.980665 N.
TEST(ImportCommand, LoadCellsBecomePairsOfAxesAndBeams) {
  const Folder folder;
  write_cells(folder);
  const Call c = call({"import", "loadcells-fareke", folder.file("cells"), "--out", folder.file("sets")});
  EXPECT_EQ(lines_of(c.out).size(), 27u) << "24 pairs and three beams" << c.out << c.err;
  EXPECT_NE(text_of(folder.file("sets/loadcell-1-x-by-y/along.csv")).find("\n0.980665,0,100000\n"), std::string::npos);
  const std::string experiment = text_of(folder.file("sets/loadcell-beam-635/experiment.yaml"));
  int cycles = 0;
  for (std::size_t at = experiment.find("file: cycle"); at != std::string::npos; at = experiment.find("file: cycle", at + 1)) ++cycles;
  EXPECT_EQ(cycles, 3);
  std::set<std::string> means;
  for (const auto& file : fs::directory_iterator(folder.file("sets/loadcell-beam-635")))
    if (file.path().filename().string().starts_with("cycle-"))
      for (const std::string& line : lines_of(text_of(file.path())))
        if (line.find("counts") == std::string::npos) means.insert(line.substr(line.rfind(',') + 1));
  EXPECT_EQ(means, (std::set<std::string>{"600.0", "-6400.0"})) << "no mean across a change of the weight";
  const Call solved = call({"reconcile", folder.file("sets/loadcell-1-x-by-y"), "--out", folder.file("report")});
  EXPECT_NE(solved.out.find("cross-talk"), std::string::npos) << solved.out << solved.err;
}

TEST(ImportCommand, WhatIsMissingOrWrongIsNamed) {
  const Folder folder;
  write_brain(folder);
  const std::string brain = folder.file("brain"), out = folder.file("out");
  expect_refused({"import", "plasticine", brain, "--out", out}, {"plasticine", "brain-budday2017, muscle-vanloocke or loadcells-fareke"});
  expect_refused({"import", "brain-budday2017", brain, "--out", brain + "/cortex_tension.csv"}, {"--out", "cortex_tension.csv", "expected a folder that can be written"});
  expect_refused({"import", "brain-budday2017", folder.file("none"), "--out", out}, {folder.file("none")});
  const std::string sound = text_of(brain + "/cortex_tension.csv");
  folder.write("brain/cortex_tension.csv", std::string(sound).replace(sound.find("\n1.005,") + 1, 5, "abc"));
  expect_refused({"import", "brain-budday2017", brain, "--out", out}, {"cortex_tension.csv:3", "abc"});
  folder.write("brain/cortex_tension.csv", sound);
  folder.write("brain/cortex_tension.csv", "stretch\n1\n1.1\n");
  expect_refused({"import", "brain-budday2017", brain, "--out", out}, {"cortex_tension.csv:1", "1 columns", "at least 2 columns"});
  folder.write("brain/cortex_tension.csv", sound);
  fs::remove(brain + "/corpus-callosum_shear.csv");
  expect_refused({"import", "brain-budday2017", brain, "--out", out}, {"corpus-callosum_shear.csv"});
}

}  // namespace import_command_test
}  // namespace filum
