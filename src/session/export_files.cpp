// Tables as CSV and HDF5 files with a data dictionary.

#include <hdf5.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <stdexcept>

#include "base/error.h"
#include "session/export.h"
#include "session/new_files.h"

namespace filum {
namespace fs = std::filesystem;
namespace {

constexpr const char* kDictionary = "data-dictionary.csv";  // of all exports in a folder
constexpr const char* kHdf5 = "recording.h5";

std::size_t length(const Column& column) {
  return std::visit([](const auto& values) { return values.size(); }, column.values);
}

std::size_t rows(const Table& table) {
  return table.columns.empty() ? 0 : length(table.columns.front());
}

/// RFC 4180: quotes round fields that need them, quotes doubled.
void append_field(std::string& line, const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) {
    line += text;
    return;
  }
  line += '"';
  for (const char c : text) {
    if (c == '"') line += '"';
    line += c;
  }
  line += '"';
}

/// Shortest text that reads back as the same double; a value that was not measured is an empty field.
void append_number(std::string& line, double value) {
  if (std::isnan(value)) return;
  char text[32];
  const auto result = std::to_chars(text, text + sizeof text, value);
  line.append(text, result.ptr);
}

void append_cell(std::string& line, const Column& column, std::size_t row) {
  if (const auto* numbers = std::get_if<std::vector<double>>(&column.values))
    return append_number(line, (*numbers)[row]);
  if (const auto* integers = std::get_if<std::vector<std::int64_t>>(&column.values)) {
    line += std::to_string((*integers)[row]);
    return;
  }
  append_field(line, std::get<std::vector<std::string>>(column.values)[row]);
}

class NewFile {
 public:
  NewFile(const NewFiles& files, const std::string& name) : path_(files.place(name)), stream_(files.aside(name), std::ios::binary) {
    if (!stream_) throw_unwritten(path_);
  }
  void write(std::span<const char> bytes) { stream_.write(bytes.data(), static_cast<std::streamsize>(bytes.size())); }
  void line(std::string& text) {
    text += "\r\n";
    write(text);
    text.clear();
  }
  void close() {
    stream_.close();
    if (!stream_) throw_unwritten(path_);
  }

 private:
  std::string path_;
  std::ofstream stream_;
};

void write_table(const Table& table, const NewFiles& files) {
  NewFile file(files, table.name + ".csv");
  std::string line;
  for (const Column& column : table.columns) {
    if (!line.empty()) line += ',';
    append_field(line, column.name);
  }
  file.line(line);
  for (std::size_t row = 0; row < rows(table); ++row) {
    for (const Column& column : table.columns) {
      if (&column != &table.columns.front()) line += ',';
      append_cell(line, column, row);
    }
    file.line(line);
  }
  file.close();
}

/// Goes on where that of another format in the folder ends.
class Dictionary {
 public:
  explicit Dictionary(const NewFiles& files) : file_(files, kDictionary) {
    std::string head = "file,column,unit,rate_hz,meaning";
    std::ifstream before(files.place(kDictionary), std::ios::binary);
    const std::string rows((std::istreambuf_iterator<char>(before)), std::istreambuf_iterator<char>());
    if (rows.starts_with(head + "\r\n"))
      file_.write(rows);
    else if (rows.empty())
      file_.line(head);
    else
      throw InputError(files.place(kDictionary), "export", "a file that is no dictionary of an export", "a folder without it");
  }
  void add(const Table& table, const std::string& where) {
    std::string line;
    for (const Column& column : table.columns) {
      append_field(line, where);
      line += ',';
      append_field(line, column.name);
      line += ',';
      append_field(line, column.unit);
      line += ',';
      if (table.rate > 0.0) append_number(line, table.rate);
      line += ',';
      append_field(line, column.meaning);
      file_.line(line);
    }
  }
  void close() { file_.close(); }

 private:
  NewFile file_;
};

[[noreturn]] void throw_library_error(const std::string& file) { throw std::runtime_error(file + ": export: found an error of HDF5, expected enough memory"); }

/// An HDF5 identifier that closes itself; a negative one is an error of the library.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t), const std::string& file) : id_(id), close_(close) {
    if (id_ < 0) throw_library_error(file);
  }
  ~Handle() { close_(id_); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }  // NOLINT: meant to convert

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// Access to a file in memory that is never on disk: where a disk is full the library cannot close a file, and crashes as the program ends.
hid_t in_memory() {
  constexpr std::size_t kGrowth = std::size_t{1} << 20;  // [bytes]
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_fapl_core(access, kGrowth, 0);
  return access;
}

class Hdf5File {
 public:
  explicit Hdf5File(const std::string& path)
      : path_((H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr), path)),
        access_(in_memory(), H5Pclose, path),
        file_(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access_), H5Fclose, path),
        text_type_(H5Tcopy(H5T_C_S1), H5Tclose, path) {
    check(H5Tset_size(text_type_, H5T_VARIABLE));
    check(H5Tset_cset(text_type_, H5T_CSET_UTF8));
  }

  void attribute(const std::string& name, const std::string& value) { attribute(file_, name, value); }

  void write(const Table& table) {
    const Handle group(H5Gcreate2(file_, table.name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose,
                       path_);
    attribute(group, "description", table.meaning);
    attribute(group, "rate_hz", table.rate);
    for (const Column& column : table.columns) write(group, column);
  }

  /// The file as it is to stand on disk.
  std::vector<char> bytes() {
    check(H5Fflush(file_, H5F_SCOPE_GLOBAL));
    const auto image = [this](void* to, std::size_t room) {
      const ssize_t size = H5Fget_file_image(file_, to, room);
      if (size < 0) throw_library_error(path_);
      return static_cast<std::size_t>(size);
    };
    std::vector<char> all(image(nullptr, 0));
    image(all.data(), all.size());
    return all;
  }

 private:
  void check(herr_t result) const {
    if (result < 0) throw_library_error(path_);
  }

  void attribute(hid_t object, const std::string& name, const std::string& value) {
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose, path_);
    const Handle made(H5Acreate2(object, name.c_str(), text_type_, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                      path_);
    const char* text = value.c_str();
    check(H5Awrite(made, text_type_, &text));
  }

  void attribute(hid_t object, const std::string& name, double value) {
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose, path_);
    const Handle made(H5Acreate2(object, name.c_str(), H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT),
                      H5Aclose, path_);
    check(H5Awrite(made, H5T_NATIVE_DOUBLE, &value));
  }

  void write(hid_t group, const Column& column) {
    const hsize_t n = length(column);
    const Handle space(H5Screate_simple(1, &n, nullptr), H5Sclose, path_);
    if (const auto* numbers = std::get_if<std::vector<double>>(&column.values)) {
      write(group, column, space, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, numbers->data());
    } else if (const auto* integers = std::get_if<std::vector<std::int64_t>>(&column.values)) {
      write(group, column, space, H5T_STD_I64LE, H5T_NATIVE_INT64, integers->data());
    } else {
      std::vector<const char*> texts;
      for (const std::string& text : std::get<std::vector<std::string>>(column.values))
        texts.push_back(text.c_str());
      write(group, column, space, text_type_, text_type_, texts.data());
    }
  }

  void write(hid_t group, const Column& column, hid_t space, hid_t stored, hid_t native, const void* data) {
    const Handle set(
        H5Dcreate2(group, column.name.c_str(), stored, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
        H5Dclose, path_);
    if (length(column) > 0) check(H5Dwrite(set, native, H5S_ALL, H5S_ALL, H5P_DEFAULT, data));
    attribute(set, "unit", column.unit);
    attribute(set, "description", column.meaning);
  }

  std::string path_;
  Handle access_;
  Handle file_;
  Handle text_type_;
};

/// What the recording is of, as a table of one row.
Table about_of(const RecordingMeta& meta) {
  Table about{"recording", 0.0, "the session", {}};
  const auto say = [&](const char* name, const char* unit, const char* meaning, const std::string& value) {
    about.columns.push_back({name, unit, meaning, std::vector<std::string>{value}});
  };
  say("task", "-", "name of the task", meta.task);
  say("participant", "-", "code of the participant", meta.participant);
  say("started", "UTC", "when the session began", meta.started_utc);
  say("input", "-", "what moved the tools", meta.input);
  say("program", "-", "version that recorded", meta.program);
  about.columns.push_back({"dt", "s", "time step of the simulation", std::vector<double>{meta.dt}});
  return about;
}

}  // namespace

void require_no_export(const std::string& folder, const std::string& format) { require_unused(fs::path(folder) / (format == "hdf5" ? kHdf5 : "recording.csv")); }

std::vector<std::string> export_csv(const std::vector<Table>& tables, const RecordingMeta& meta,
                                    const std::string& folder) {
  const Table about = about_of(meta);
  std::vector<const Table*> all;
  for (const Table& table : tables) all.push_back(&table);
  all.push_back(&about);
  std::vector<std::string> names;
  for (const Table* table : all) names.push_back(table->name + ".csv");
  NewFiles files(folder, names, kDictionary);
  Dictionary dictionary(files);
  for (const Table* table : all) {
    write_table(*table, files);
    dictionary.add(*table, table->name + ".csv");
  }
  dictionary.close();
  return files.put();
}

std::vector<std::string> export_hdf5(const std::vector<Table>& tables, const RecordingMeta& meta,
                                     const std::string& folder) {
  const std::string name = kHdf5;
  NewFiles files(folder, {name}, kDictionary);
  Hdf5File file(files.place(name));
  file.attribute("task", meta.task);
  file.attribute("participant", meta.participant);
  file.attribute("started_utc", meta.started_utc);
  file.attribute("input", meta.input);
  file.attribute("program", meta.program);
  for (const Table& table : tables) file.write(table);
  NewFile on_disk(files, name);
  on_disk.write(file.bytes());
  on_disk.close();
  Dictionary dictionary(files);
  for (const Table& table : tables) dictionary.add(table, name + ":" + table.name);
  dictionary.close();
  return files.put();
}

}  // namespace filum
