#include <gtest/gtest.h>
#include <hdf5.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#include "base/error.h"
#include "session/export.h"
#include "tests/session/disk_limit.h"
#include "tests/session/synthetic.h"

namespace filum {
namespace export_files_test {

using Cells = std::vector<std::vector<std::string>>;

/// An independent reader of RFC 4180.
Cells read_csv(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  Cells rows;
  std::vector<std::string> row{""};
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted) {
      if (c == '"' && i + 1 < text.size() && text[i + 1] == '"') {
        row.back() += text[++i];
      } else if (c == '"') {
        quoted = false;
      } else {
        row.back() += c;
      }
    } else if (c == '"') {
      quoted = true;
    } else if (c == ',') {
      row.emplace_back();
    } else if (c == '\r' && i + 1 < text.size() && text[i + 1] == '\n') {
      ++i;
      rows.push_back(row);
      row = {""};
    } else {
      row.back() += c;
    }
  }
  EXPECT_EQ(row, std::vector<std::string>{""}) << "the last line is not ended";
  return rows;
}

std::vector<Table> odd_tables() {
  return {{"odd",
           500.0,
           "cells that need care",
           {{"number", "N", "a number", std::vector<double>{0.1, std::nan(""), -1e-300}},
            {"whole", "count", "an integer",
             std::vector<std::int64_t>{std::numeric_limits<std::int64_t>::min(), 0, 7}},
            {"text", "-", "a, \"meaning\"", std::vector<std::string>{"a,b", "say \"x\"", "two\r\nlines"}}}},
          {"empty", 0.0, "no rows", {{"x", "m", "nothing", std::vector<double>{}}}}};
}

TEST(ExportCsv, IsRfc4180AndReadsBackExactly) {
  const synthetic::Folder folder;
  const auto files = export_csv(odd_tables(), synthetic::meta(), folder.file("out/deep"));
  EXPECT_EQ(files.size(), 4u);
  const Cells cells = read_csv(folder.file("out/deep/odd.csv"));
  ASSERT_EQ(cells.size(), 4u);
  EXPECT_EQ(cells[0], (std::vector<std::string>{"number", "whole", "text"}));
  EXPECT_EQ(cells[1], (std::vector<std::string>{"0.1", "-9223372036854775808", "a,b"}));
  EXPECT_EQ(cells[2], (std::vector<std::string>{"", "0", "say \"x\""}));
  EXPECT_EQ(std::stod(cells[3][0]), -1e-300);
  EXPECT_EQ(cells[3][2], "two\r\nlines");
  EXPECT_EQ(read_csv(folder.file("out/deep/empty.csv")).size(), 1u);
}

TEST(ExportCsv, TheDictionaryNamesEveryColumnOfEveryFile) {
  const synthetic::Folder folder;
  synthetic::write_recording(folder.file("a"), 100);
  const RecordingReader recording(folder.file("a"));
  const auto files = export_csv(recorded_tables(recording), recording.meta(), folder.file("out"));
  const Cells dictionary = read_csv(folder.file("out/data-dictionary.csv"));
  EXPECT_EQ(dictionary[0], (std::vector<std::string>{"file", "column", "unit", "rate_hz", "meaning"}));
  std::size_t described = 1;
  for (const std::string& file : files) {
    const std::string name = std::filesystem::path(file).filename();
    if (name == "data-dictionary.csv") continue;
    const Cells cells = read_csv(file);
    for (const std::string& column : cells[0]) {
      ++described;
      const bool found = std::any_of(dictionary.begin(), dictionary.end(), [&](const auto& row) {
        return row[0] == name && row[1] == column && !row[2].empty() && !row[4].empty();
      });
      EXPECT_TRUE(found) << name << " " << column;
    }
  }
  EXPECT_EQ(dictionary.size(), described);
}

class Opened {
 public:
  explicit Opened(const std::string& file) : id(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT)) {}
  ~Opened() { H5Fclose(id); }
  hid_t id;
};

std::string text_attribute(hid_t set, const char* name) {
  const hid_t attribute = H5Aopen(set, name, H5P_DEFAULT);
  const hid_t type = H5Aget_type(attribute);
  char* text = nullptr;
  H5Aread(attribute, type, &text);
  const std::string result = text != nullptr ? text : "";
  H5free_memory(text);
  H5Tclose(type);
  H5Aclose(attribute);
  return result;
}

TEST(ExportHdf5, HoldsTheSameNumbersWithUnitAndRate) {
  const synthetic::Folder folder;
  synthetic::write_recording(folder.file("a"), 100);
  const RecordingReader recording(folder.file("a"));
  const auto files = export_hdf5(recorded_tables(recording), recording.meta(), folder.file("out"));
  ASSERT_EQ(files.size(), 2u);
  const Opened file(files[0]);
  ASSERT_GE(file.id, 0);
  const hid_t set = H5Dopen2(file.id, "inputs/tool0_p_x", H5P_DEFAULT);
  ASSERT_GE(set, 0);
  std::vector<double> x(100);
  ASSERT_GE(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, x.data()), 0);
  for (std::size_t i = 0; i < 100; ++i) EXPECT_EQ(x[i], synthetic::step(i + 1).inputs.tools[0].X_WD.p.x());
  EXPECT_EQ(text_attribute(set, "unit"), "m");
  EXPECT_FALSE(text_attribute(set, "description").empty());
  H5Dclose(set);
  const hid_t group = H5Gopen2(file.id, "inputs", H5P_DEFAULT);
  const hid_t rate = H5Aopen(group, "rate_hz", H5P_DEFAULT);
  double hz = 0.0;
  H5Aread(rate, H5T_NATIVE_DOUBLE, &hz);
  EXPECT_DOUBLE_EQ(hz, 500.0);
  H5Aclose(rate);
  H5Gclose(group);
  EXPECT_EQ(text_attribute(file.id, "task"), "knot-square");
}

TEST(ExportHdf5, TakesTextsAndEmptyTables) {
  const synthetic::Folder folder;
  const auto files = export_hdf5(odd_tables(), synthetic::meta(), folder.file("out"));
  const Opened file(files[0]);
  const hid_t set = H5Dopen2(file.id, "odd/text", H5P_DEFAULT);
  const hid_t type = H5Dget_type(set);
  const hid_t space = H5Dget_space(set);
  char* texts[3] = {};
  ASSERT_GE(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, texts), 0);
  EXPECT_STREQ(texts[2], "two\r\nlines");
  H5Dvlen_reclaim(type, space, H5P_DEFAULT, texts);
  H5Sclose(space);
  H5Tclose(type);
  H5Dclose(set);
}

TEST(Export, AFolderThatCannotBeWrittenIsAnInputError) {
  const synthetic::Folder folder;
  std::ofstream(folder.file("file")) << "x";
  EXPECT_THROW(export_csv(odd_tables(), synthetic::meta(), folder.file("file/below")), InputError);
  EXPECT_THROW(export_hdf5(odd_tables(), synthetic::meta(), folder.file("file/below")), InputError);
  std::filesystem::create_directory(folder.file("locked"));
  std::filesystem::permissions(folder.path(), std::filesystem::perms(0755));
  std::filesystem::permissions(folder.file("locked"), std::filesystem::perms(0555));
  const synthetic::OrdinaryUser user;
  ASSERT_TRUE(user.is());
  EXPECT_THROW(export_csv(odd_tables(), synthetic::meta(), folder.file("locked")), InputError);
  EXPECT_THROW(export_hdf5(odd_tables(), synthetic::meta(), folder.file("locked")), InputError);
}

std::vector<std::string> names_in(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

using Exporter = std::vector<std::string> (*)(const std::vector<Table>&, const RecordingMeta&, const std::string&);
constexpr Exporter kExporters[] = {export_csv, export_hdf5};

/// What an export says where it ends; empty: it did not.
std::string failure(Exporter exporter, const std::string& folder) {
  const std::vector<Table> long_ones = {{"long", 500.0, "longer than there is room", {{"x", "m", "numbers", std::vector<double>(4000, 0.1)}}}};
  try {
    exporter(long_ones, synthetic::meta(), folder);
  } catch (const InputError& error) {
    return std::string("bad input: ") + error.what();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

TEST(Export, OfAnExportOntoAFullDiskNothingIsLeft) {
  const synthetic::Folder folder;
  std::filesystem::create_directory(folder.file("there"));
  std::ofstream(folder.file("there/mine")) << "x";
  {
    const DiskLimit limit(8192);
    for (const Exporter exporter : kExporters) {
      EXPECT_NE(failure(exporter, folder.file("new")).find("export: found a write error, expected a disk with space left"), std::string::npos);
      EXPECT_EQ(failure(exporter, folder.file("there")).find(folder.file("there")), 0u) << "no bad input, and by the name it was to have";
    }
  }
  EXPECT_FALSE(std::filesystem::exists(folder.file("new")));
  EXPECT_EQ(names_in(folder.file("there")), std::vector<std::string>{"mine"});
  for (const Exporter exporter : kExporters) EXPECT_EQ(failure(exporter, folder.file(exporter == export_csv ? "csv" : "hdf5")), "") << "there is room again";
}

TEST(Export, AnExportIsNeverWrittenOver) {
  const synthetic::Folder folder;
  for (const Exporter exporter : kExporters) {
    const std::string format = exporter == export_csv ? "csv" : "hdf5", name = folder.file(format);
    EXPECT_NO_THROW(require_no_export(name, format));
    exporter(odd_tables(), synthetic::meta(), name);
    const auto before = names_in(name);
    EXPECT_THROW(require_no_export(name, format), InputError);
    EXPECT_NE(failure(exporter, name).find("bad input: "), std::string::npos);
    EXPECT_EQ(names_in(name), before);
  }
  std::filesystem::create_directory(folder.file("other"));
  std::ofstream(folder.file("other/long.csv")) << "somebody's own";
  EXPECT_NE(failure(export_csv, folder.file("other")).find("long.csv: export: found a file that exists"), std::string::npos);
  EXPECT_EQ(names_in(folder.file("other")), std::vector<std::string>{"long.csv"});
  std::filesystem::create_directory(folder.file("third"));
  std::ofstream(folder.file("third/data-dictionary.csv")) << "somebody's own";
  EXPECT_NE(failure(export_hdf5, folder.file("third")).find("no dictionary of an export"), std::string::npos);
  EXPECT_EQ(names_in(folder.file("third")), std::vector<std::string>{"data-dictionary.csv"});
}

TEST(Export, BothFormatsShareAFolderAndItsDictionary) {
  const synthetic::Folder folder;
  const auto rows = [&](const char* name) {
    std::ifstream file(folder.file(name) + "/data-dictionary.csv");
    std::vector<std::string> lines;
    for (std::string line; std::getline(file, line);) lines.push_back(line);
    return lines;
  };
  for (const Exporter exporter : kExporters) {
    exporter(odd_tables(), synthetic::meta(), folder.file("both"));
    exporter(odd_tables(), synthetic::meta(), folder.file(exporter == export_csv ? "csv" : "hdf5"));
  }
  std::vector<std::string> expected = rows("csv"), more = rows("hdf5");
  expected.insert(expected.end(), more.begin() + 1, more.end());
  EXPECT_EQ(rows("both"), expected);
}

}  // namespace export_files_test
}  // namespace filum
