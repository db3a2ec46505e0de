#include "anatomy/mesh_program.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "anatomy/brain_mesher.h"
#include "base/error.h"
#include "base/out_folder.h"

namespace filum {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string scan, out;
  std::vector<double> at;  // [mm]
  double radius = 35.0, depth = 35.0, fine = 3.0, coarse = 7.0, smooth = 1.5, wear = 5.0;  // [mm]
  bool extracted = false, json = false;
};

/// A model of format filum-brain/1 about the mesh beside it; tissue as in models/brain/convexity.yaml.
void write_model(const Options& o, const std::string& path) {
  std::ofstream file(path);
  const auto line = [&](const char* indent, const char* name, const char* value, const char* uncertainty, const char* source) {
    file << indent << name << ": { value: \"" << value << "\", uncertainty: \"" << uncertainty << "\", source: \"" << source << "\" }\n";
  };
  const auto tissue = [&](const char* name, const char* young, const char* uncertainty) {
    file << name << ":\n";
    line("  ", "young", young, uncertainty, "as in models/brain/convexity.yaml");
    line("  ", "poisson", "0.45", "0.04", "as in models/brain/convexity.yaml");
    line("  ", "density", "1040 kg/m3", "10 kg/m3", "handbook value, to be verified");
  };
  file << "format: filum-brain/1\ntitle: \"Brain region of " << fs::path(o.scan).filename().string() << "\"\nmesh: mesh.txt\n"
       << "held_below: \"" << -(o.depth - 0.5 * o.coarse) << " mm\"\nheld_beyond: \"" << o.radius - 0.3 * o.fine << " mm\"\n";
  tissue("grey", "2.9 kPa", "1.5 kPa");
  tissue("white", "3.9 kPa", "2 kPa");
  file << "stiffness_dial: \"1\"\n";
  line("", "mass_damping", "20 1/s", "20 1/s", "[P]");
  line("", "stiffness_damping", "10 ms", "10 ms", "[P]");
  line("", "relaxing_share", "0.75", "0.15", "as in models/brain/convexity.yaml");
  line("", "relaxation_time", "360 s", "120 s", "as in models/brain/convexity.yaml");
  line("", "friction", "0.2", "0.1", "[P]");
  file << "reach: \"" << 2.0 * o.fine << " mm\"\n";
  if (!file) throw InputError(path, "file", "cannot be written", "a folder that can be");
}

nlohmann::ordered_json report(const BrainScan& s, const BrainRegion& r) {
  const MeshQuality q = mesh_quality(r.mesh);
  const auto list = [](const Vec3& v, double unit) { return std::vector<double>{v.x() / unit, v.y() / unit, v.z() / unit}; };
  return {{"nodes", r.mesh.n_nodes()},
          {"tetrahedra", r.mesh.n_tets()},
          {"dropped_tetrahedra", r.dropped},
          {"quality", {{"worst_radius_ratio", q.worst_shape}, {"mean_radius_ratio", q.mean_shape}, {"shortest_edge_mm", 1e3 * q.shortest_edge}, {"longest_edge_mm", 1e3 * q.longest_edge}, {"smallest_volume_mm3", 1e9 * q.smallest_volume}}},
          {"grey_ml", 1e6 * r.grey},
          {"white_ml", 1e6 * r.white},
          {"scan", {{"brain_ml", 1e6 * s.volume}, {"threshold", s.threshold}, {"means", s.means}, {"middle_mm", list(s.middle, 1e-3)}}},
          {"window", {{"origin_mm", list(r.origin, 1e-3)}, {"outward", list(r.axes.col(2), 1.0)}, {"front", list(r.axes.col(1), 1.0)}}}};
}

/// [mm]. A number that is not one is refused, too.
void check(const char* option, double value, double low, double high) {
  if (!(value >= low && value <= high)) throw InputError(option, "length", std::to_string(value) + " mm", std::to_string(low) + " to " + std::to_string(high) + " mm");
}

int run(const Options& o, std::FILE* out) {
  constexpr double kMm = 1e-3;
  if (o.at.size() != 3) throw InputError("--at", "place", std::to_string(o.at.size()) + " numbers", "x,y,z in mm of the scanner");
  check("--smooth", o.smooth, 0.0, 20.0);
  check("--wear", o.wear, 0.0, 20.0);
  for (const double v : o.at) check("--at", v, -1000.0, 1000.0);
  require_out_folder("--out", o.out);
  const BrainScan scan = find_brain(read_nifti(o.scan), {o.extracted, kMm * o.wear, kMm * o.smooth}, o.scan);
  const BrainRegion region = mesh_region(scan, {kMm * Vec3(o.at[0], o.at[1], o.at[2]), kMm * o.radius, kMm * o.depth, kMm * o.fine, kMm * o.coarse}, o.scan);
  fs::create_directories(o.out);
  save_mesh(region.mesh, o.out + "/mesh.txt");
  write_model(o, o.out + "/brain.yaml");
  const nlohmann::ordered_json json = report(scan, region);
  std::ofstream(o.out + "/report.json") << json.dump(2) << '\n';
  if (o.json) std::fprintf(out, "%s\n", json.dump(2).c_str());
  else std::fprintf(out, "%d nodes, %d tetrahedra, worst radius ratio %.3f (mean %.2f); %s\n", region.mesh.n_nodes(), region.mesh.n_tets(), mesh_quality(region.mesh).worst_shape, mesh_quality(region.mesh).mean_shape, (o.out + "/brain.yaml").c_str());
  return 0;
}

}  // namespace

int mesh_program(int argc, const char* const* argv, std::FILE* out, std::FILE* err) {
  CLI::App app{"A brain region as tetrahedra from a head scan (NIfTI-1, T1-weighted)"};
  app.name("filum mesh");
  Options o;
  app.add_option("scan", o.scan, "The scan: .nii, .nii.gz or .hdr/.img")->required();
  app.add_option("--out", o.out, "Folder for mesh.txt, brain.yaml and report.json")->required();
  app.add_option("--at", o.at, "Middle of the craniotomy, x,y,z in mm of the scanner; seen from the middle of the brain")->delimiter(',')->required();
  app.add_option("--radius", o.radius, "Of the region, mm");
  app.add_option("--depth", o.depth, "Of the region, mm");
  app.add_option("--fine", o.fine, "Size of elements at the cortex, mm");
  app.add_option("--coarse", o.coarse, "Size of elements at the depth, mm");
  app.add_option("--smooth", o.smooth, "Smoothing of the scan's classes, mm");
  app.add_option("--wear", o.wear, "By how much scalp and brain are worn to part, mm");
  app.add_flag("--extracted", o.extracted, "The scan holds nothing but the brain");
  app.add_flag("--json", o.json, "The report as JSON on stdout");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::ostringstream help, fault;
    const int code = app.exit(error, help, fault);
    std::fputs(help.str().c_str(), out);
    std::fputs(fault.str().c_str(), err);
    return code == 0 ? 0 : 2;
  }
  try {
    return run(o, out);
  } catch (const InputError& error) {
    std::fprintf(err, "filum: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(err, "filum: %s\n", error.what());
    return 1;
  }
}

}  // namespace filum
