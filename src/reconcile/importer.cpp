#include "reconcile/importer.h"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <sstream>

#include "base/error.h"
#include "base/file_kind.h"
#include "reconcile/csv_table.h"
#include "reconcile/whole_file.h"

namespace filum::reconcile {
namespace {

namespace fs = std::filesystem;

constexpr double kSide = 5e-3;  // [m], the cube that stresses are turned into forces of

std::string head(const std::string& title, const std::string& source, const std::string& free) {
  return "format: filum-experiment/1\ntitle: \"" + title + "\"\nsource: \"" + source +
         "\"\nrig: tissue-block\nspecimen: { shape: cuboid, length: \"5 mm\", width: \"5 mm\", height: \"5 mm\" }\nmodel:\n  file: brain/linear\n  free: [" + free +
         "]\nchannels:\n  - { name: time, column: t_s, unit: s }\n  - { name: displacement, column: u_mm, unit: mm, kind: input }\n  - { name: force, column: F_mN, unit: mN, kind: output }\ntrials:\n";
}

/// t [s], displacement [m] and force [N] as a file of the contract; equal or falling times are left out.
void write_trial(const fs::path& path, const Eigen::VectorXd& t, const Eigen::VectorXd& u, const Eigen::VectorXd& f) {
  std::ostringstream s;
  s << "t_s,u_mm,F_mN\n";
  double last = -1e300;
  for (Eigen::Index i = 0; i < t.size(); ++i) {
    if (!(t[i] > last)) continue;
    last = t[i];
    char line[120];
    std::snprintf(line, sizeof line, "%.7g,%.7g,%.7g\n", t[i], 1e3 * u[i], 1e3 * f[i]);
    s << line;
  }
  write_whole(path.string(), s.str());
}

/// Specimen means without a clock: the sample's number stands for the time, so nothing about rate can be said.
std::vector<std::string> brain(const std::string& folder, const std::string& out) {
  std::vector<std::string> made;
  for (const std::string region : {"cortex", "basal-ganglia", "corona-radiata", "corpus-callosum"}) {
    const fs::path to = fs::path(out) / ("brain-" + region);
    fs::create_directories(to);
    std::string yaml = head("Human brain, " + region + ": tension, compression, shear (specimen means, no clock)",
                            "Budday et al., Acta Biomaterialia 48 (2017) 319-340, digitised in Calibration-Hyperelasticity (C.-Z. Zhao, MIT)", "youngs_modulus, poissons_ratio");
    for (const std::string mode : {"compression", "tension", "shear"}) {
      const CsvTable table = CsvTable::load((fs::path(folder) / (region + "_" + mode + ".csv")).string());
      const bool shear = mode == "shear";
      const Eigen::VectorXd strain = (table.numbers(0).array() - (shear ? 0.0 : 1.0)).matrix(), stress = table.numbers(1) * 1e3;
      const Eigen::VectorXd t = Eigen::VectorXd::LinSpaced(strain.size(), 0.0, static_cast<double>(strain.size()) - 1.0);
      write_trial(to / (mode + ".csv"), t, strain * kSide, stress * kSide * kSide);
      yaml += "  - { file: " + mode + ".csv, protocol: { mode: " + mode + " } }\n";
    }
    write_whole((to / "experiment.yaml").string(), yaml);
    made.push_back(to.filename().string());
  }
  return made;
}

/// Cauchy stress of an incompressible specimen: nominal stress = Cauchy stress / stretch. The fastest ramp is held out.
std::vector<std::string> muscle(const std::string& folder, const std::string& out) {
  std::vector<std::string> made;
  for (const auto& [letter, name] : std::vector<std::pair<std::string, std::string>>{{"F", "along"}, {"XF", "across"}}) {
    const fs::path to = fs::path(out) / ("muscle-" + name);
    fs::create_directories(to);
    std::string yaml = head("Porcine muscle compressed " + name + " the fibres", "Van Loocke, Lyons, Simms, J. Biomechanics 2008/2009, as used by Wang, Linka, Kuhl, JMBBM 2023", "youngs_modulus");
    for (const std::string run : {"10", "20", "30", "005", "01", "05"}) {
      const fs::path from = fs::path(folder) / (letter + "_" + run + ".csv");
      const CsvTable table = CsvTable::load(from.string());
      const Eigen::VectorXd t = table.numbers(0), stretch = table.numbers(1), stress = table.numbers(2) * 1e3;
      write_trial(to / ("run-" + run + ".csv"), t, ((stretch.array() - 1.0) * kSide).matrix(), (stress.array() / stretch.array() * kSide * kSide).matrix());
      yaml += "  - { file: run-" + run + ".csv, protocol: { mode: compression, cycle: \"" + run + "\" }" + (run == "05" ? ", hold_out: true" : "") + " }\n";
    }
    write_whole((to / "experiment.yaml").string(), yaml);
    made.push_back(to.filename().string());
  }
  return made;
}

/// A three-axis cell is read as two channels of a bridge at a time: load on the axis itself stands where forceps have their angle (1 N as 1
/// rad, since a bridge answers to what bends it), load on another axis where they have the grip, so that cross-talk is cross-talk.
/// Published in gram-force, free of the weight of the cell's own parts ("corrected"); no clock, no replicates, ten loads a pair: the noise is stated as half a
/// gram-force, what a full matrix leaves of these cells.
std::vector<std::string> load_cells(const std::string& folder, const std::string& out) {
  constexpr double kGramForce = 9.80665e-3;  // [N]
  const std::string axes = "xyz";
  std::vector<std::string> made;
  for (const char cell : {'1', '2', '3', '4'}) {
    const CsvTable table = CsvTable::load((fs::path(folder) / (std::string("3axisCell") + cell + "CalibrationData.csv")).string());
    const auto column = [&](const std::string& name) { return table.numbers(table.column(name)); };
    for (const char own : axes)
      for (const char other : axes) {
        if (own == other) continue;
        const fs::path to = fs::path(out) / (std::string("loadcell-") + cell + "-" + own + "-by-" + other);
        fs::create_directories(to);
        const Eigen::VectorXd load = column(std::string("force_") + own) * kGramForce, side = column(std::string("force_") + other) * kGramForce, counts = column(std::string("corrected_") + own);
        const Eigen::VectorXd third = column(std::string("force_") + static_cast<char>('x' + 'y' + 'z' - own - other));
        const double noise = 0.5 * kGramForce * std::abs((counts.maxCoeff() - counts.minCoeff()) / std::max(load.maxCoeff() - load.minCoeff(), 1e-9));
        std::string yaml = std::string("format: filum-experiment/1\ntitle: \"Load cell ") + cell + ", axis " + own + " against load on " + other +
                           " (1 rad stands for 1 N)\"\nsource: FARE-KE repository, 2025\nrig: forceps-bridge\nspecimen: { bits: 24, reference: \"5 V\" }\n"
                           "model: { file: forceps/linear, free: [strain_gain, strain_offset] }\nchannels:\n  - { name: angle, column: own_N, unit: rad, kind: input }\n"
                           "  - { name: grip_force, column: other_N, unit: N, kind: input }\n  - { name: strain_counts, column: counts, unit: count, kind: output, noise: \"" +
                           std::to_string(noise) + " count\" }\ntrials:\n";
        for (const bool aside : {false, true}) {
          std::ostringstream s;
          s << "own_N,other_N,counts\n";
          for (Eigen::Index i = 0; i < load.size(); ++i) {
            if (third[i] != 0.0 || (aside ? load[i] : side[i]) != 0.0) continue;
            char line[120];
            std::snprintf(line, sizeof line, "%.7g,%.7g,%.9g\n", load[i], side[i], counts[i]);
            s << line;
          }
          const std::string file = aside ? "aside.csv" : "along.csv";
          write_whole((to / file).string(), s.str());
          yaml += "  - { file: " + file + " }\n";
        }
        write_whole((to / "experiment.yaml").string(), yaml);
        made.push_back(to.filename().string());
      }
  }
  return made;
}

/// Three beam cells under one weight that is put on and taken off for 57 minutes: mean counts of every forty readings (4.5 s) wholly within one state, which the
/// counts themselves tell (a weight is the whole range); each time on and off is a trial, the last held out. Weight on stands for 1 rad: its size is not given.
std::vector<std::string> beams(const std::string& folder, const std::string& out) {
  constexpr Eigen::Index kBlock = 40, kAside = 30;
  const CsvTable table = CsvTable::load((fs::path(folder) / "loadingTest.csv").string());
  const Eigen::VectorXd clock = table.numbers(1) * 1e-3;  // [ms] in the file
  std::vector<std::string> made;
  for (const auto& [column, cell] : std::vector<std::pair<int, std::string>>{{3, "635"}, {4, "degraw"}, {5, "tal220"}}) {
    const Eigen::VectorXd counts = table.numbers(column);
    const double middle = 0.5 * (counts.minCoeff() + counts.maxCoeff());
    const auto state = [&](Eigen::Index i) { return counts[i] < middle; };
    std::vector<std::string> cycles(1);
    std::vector<int> rows(1, 0);
    bool last = false;
    for (Eigen::Index i = 0, run = 0; i < counts.size(); ++i) {
      run = i > 0 && state(i) == state(i - 1) ? run + 1 : 0;
      if (run < kBlock + kAside - 1 || (run - kAside + 1) % kBlock != 0) continue;
      if (i + kAside < counts.size() && state(i + kAside) != state(i)) continue;
      if (last && !state(i)) cycles.emplace_back(), rows.push_back(0);
      last = state(i);
      char line[120];
      std::snprintf(line, sizeof line, "%.3f,%d,0,%.1f\n", clock.segment(i - kBlock + 1, kBlock).mean() - clock[0], last ? 1 : 0, counts.segment(i - kBlock + 1, kBlock).mean());
      cycles.back() += line;
      ++rows.back();
    }
    const std::string name = "loadcell-beam-" + cell;
    const fs::path to = fs::path(out) / name;
    fs::create_directories(to);
    std::string yaml = "format: filum-experiment/1\ntitle: \"Beam cell " + cell + ", a weight on and off (1 rad stands for the weight)\"\nsource: FARE-KE repository, 2025\nrig: forceps-bridge\nspecimen: { bits: 24, reference: \"5 V\" }\n"
                       "model: { file: forceps/linear, free: [strain_gain, strain_offset] }\nchannels:\n  - { name: time, column: t_s, unit: s }\n  - { name: angle, column: weight, unit: rad, kind: input }\n"
                       "  - { name: grip_force, column: none_N, unit: N, kind: input }\n  - { name: strain_counts, column: counts, unit: count, kind: output }\ntrials:\n";
    std::vector<std::size_t> whole;
    for (std::size_t k = 0; k < cycles.size(); ++k)
      if (rows[k] >= 8) whole.push_back(k);
    for (const std::size_t k : whole) {
      const std::string file = "cycle-" + std::to_string(k + 1) + ".csv";
      write_whole((to / file).string(), "t_s,weight,none_N,counts\n" + cycles[k]);
      yaml += "  - { file: " + file + ", repeat: A" + (k == whole.back() ? ", hold_out: true" : "") + " }\n";
    }
    write_whole((to / "experiment.yaml").string(), yaml);
    made.push_back(name);
  }
  return made;
}

}  // namespace

std::vector<std::string> import_kinds() { return {"brain-budday2017", "muscle-vanloocke", "loadcells-fareke"}; }

std::vector<std::string> import_data(const std::string& kind, const std::string& folder, const std::string& out) {
  if (!is_folder(folder)) throw InputError(folder, "folder", "no such folder", "the folder of the published tables");
  if (kind == "brain-budday2017") return brain(folder, out);
  if (kind == "muscle-vanloocke") return muscle(folder, out);
  if (kind == "loadcells-fareke") {
    auto made = load_cells(folder, out);
    for (const std::string& name : beams(folder, out)) made.push_back(name);
    return made;
  }
  throw InputError("import", "KIND", kind, "brain-budday2017, muscle-vanloocke or loadcells-fareke");
}

}  // namespace filum::reconcile
