#pragma once
// Recordings as tables for other programs: CSV (RFC 4180) and HDF5, each with a data dictionary.

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "session/recording_reader.h"
#include "world/world.h"

namespace filum {

struct Column {
  std::string name;
  std::string unit;  // "m", "N", "count", "-"
  std::string meaning;
  std::variant<std::vector<double>, std::vector<std::int64_t>, std::vector<std::string>> values;
};

struct Table {
  std::string name;   // file name in CSV, group in HDF5
  double rate = 0.0;  // [Hz], of samples the mean of a tool's readings; 0: not regular
  std::string meaning;
  std::vector<Column> columns;  // all of one length
};

/// What can be read of the stored channels: "inputs", "samples", "events", "array_hashes", "score".
std::vector<Table> recorded_tables(const RecordingReader& recording);

/// Re-steps the recording, as far as its steps can be read, in `world` (fresh from its sources): tool poses, velocities, forces, grips, thread
/// tension. "simulated".
Table simulated_table(const RecordingReader& recording, World& world);

/// Throws InputError where `folder` holds an export of this format, csv or hdf5: none is written over. Both may lie in one folder, with one dictionary.
void require_no_export(const std::string& folder, const std::string& format);

/// One NAME.csv for each table and data-dictionary.csv (file, column, unit, rate_hz, meaning) in `folder`,
/// which is made. Returns the files written: all, or none with an exception. Throws InputError when the folder cannot be written or
/// holds one of the files, std::runtime_error when the disk is full.
std::vector<std::string> export_csv(const std::vector<Table>& tables, const RecordingMeta& meta,
                                    const std::string& folder);

/// folder/recording.h5 (a group for each table; attributes rate_hz, description; unit and description on each
/// data set) and data-dictionary.csv. Throws as export_csv().
std::vector<std::string> export_hdf5(const std::vector<Table>& tables, const RecordingMeta& meta,
                                     const std::string& folder);

/// A Motion-BIDS dataset in `folder`; recordings exported to the same folder join it. Returns the files written. Where the disk is full
/// those that are there are whole (std::runtime_error).
std::vector<std::string> export_bids(const RecordingReader& recording, const std::string& folder);

}  // namespace filum
