#pragma once
// A measured dataset (filum-experiment/1) in SI units. Reading is strict: whatever is wrong is an InputError that names
// file, line, column and what was expected.

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "reconcile/catalogue.h"

namespace filum::reconcile {

struct Channel {
  std::string name;    // in the contract
  std::string column;  // in the CSV files
  std::string unit;    // as written
  double scale = 1.0, shift = 0.0;  // SI = scale * cell + shift
  bool input = false;
  double noise = 0.0;  // [SI], one standard deviation; 0 where not stated
};

struct Trial {
  std::string file;
  std::map<std::string, std::string> protocol;
  std::map<std::string, double> specimen;  // [SI], those of the dataset with its own put over them
  std::string shape;                       // cuboid, cylinder, box, or empty
  std::string repeat;
  bool hold_out = false;
  Eigen::VectorXd time;                    // [s]; the sample's number where there is no clock
  bool clocked = true;
  std::map<std::string, Eigen::VectorXd> data;  // [SI] channel -> samples, NaN where missing
  int missing = 0;
  std::map<std::string, double> tracked;        // [SI], median standard deviation of a channel that a video gave

  int samples() const { return static_cast<int>(time.size()); }
  bool has(const std::string& channel) const { return data.count(channel) > 0; }
  const Eigen::VectorXd& at(const std::string& channel) const { return data.at(channel); }
  double size(const std::string& key, double otherwise = 0.0) const;
  std::string word(const std::string& key) const;
};

struct Prior {
  double low, high;  // [SI]
};

struct Dataset {
  std::string name, title, source, folder;
  Rig rig = Rig::tissue_block;
  std::string model;
  std::map<std::string, double> nominal;  // [SI] baseline values of the model file
  std::vector<std::string> free;
  std::map<std::string, Prior> prior;
  std::vector<Channel> channels;
  std::vector<std::string> outputs;       // names, in the order of the file
  std::vector<Trial> trials;
  std::vector<std::string> notices;
  int thinned = 1;                        // samples that one stands for (thin.h)
  std::uint64_t hash = 0;

  /// Adds a notice, once.
  void note(const std::string& text);
  const Channel& channel(const std::string& name) const;
  /// Protocol and specimen of a trial as one text: trials with equal text are the same protocol.
  std::string protocol_text(const Trial& trial) const;
};

/// Reads DIR/experiment.yaml and its files. `root` holds models/.
Dataset load_dataset(const std::string& folder, const std::string& root);

}  // namespace filum::reconcile
