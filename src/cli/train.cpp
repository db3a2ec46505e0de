// filum train: the trainer with its server, until it is told to end.

#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <memory>

#include "cli/number_range.h"
#include "cli/options.h"
#include "cli/trainer.h"

namespace filum {
namespace {

std::atomic<bool> quit{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void on_signal(int) { quit.store(true); }

struct TrainOptions {
  CommonOptions common;
  TrainerOptions trainer;
};

int run(const TrainOptions& o, const Streams& io) {
  quit.store(false);
  TrainerOptions options = o.trainer;
  options.root = o.common.root;
  if (options.store_folder.empty()) options.store_folder = default_store_folder();
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  std::signal(SIGPIPE, SIG_IGN);
  Trainer trainer(std::move(options));
  if (!trainer.store_warning().empty()) std::fprintf(io.err, "filum: %s\n", trainer.store_warning().c_str());
  std::fprintf(io.out, "Filum trainer: %s\n", trainer.url().c_str());
  std::fflush(io.out);
  trainer.run(quit);
  return kDone;
}

}  // namespace

void add_train(CLI::App& app, Action& action) {
  auto o = std::make_shared<TrainOptions>();
  CLI::App* command = app.add_subcommand("train", "Start the trainer and print the address to open in a browser");
  command->add_option("--port", o->trainer.port, "Port; 0 takes any free one")->capture_default_str();
  command->add_option("--address", o->trainer.address, "Address to listen on")->capture_default_str();
  command->add_option("--serial", o->trainer.serial_port, "Serial port of the forceps, e.g. /dev/ttyACM0");
  command->add_option("--forceps", o->trainer.calibration, "Calibration of the forceps (from filum calibrate forceps)");
  command->add_option("--hands", o->trainer.hands, "Devices that know where the hands are: haptic:[ADDRESS:]PORT, igtl:[ADDRESS:]PORT, several joined by +");
  command->add_option("--motion-scale", o->trainer.motion_scale, "Movement in the scene over that of the hand, with --hands")->check(between(0.001, 10.0))->capture_default_str();
  command->add_option("--igtl-out", o->trainer.igtl_out, "Send the tools' poses by OpenIGTLink from this port of this machine")->check(CLI::Range(1, 65535));
  command->add_option("--camera", o->trainer.camera, "Video or pictures for the calibration of a camera, instead of a camera");
  command->add_option("--model", o->trainer.model_file, "A model.yaml of filum reconcile, for the tasks whose scene can show it");
  command->add_option("--datasets", o->trainer.datasets, "Folder of measurements for reconcile in the browser (default: datasets below the store)");
  command->add_option("--store", o->trainer.store_folder, "Folder of the recordings (default: your data folder)");
  o->trainer.viewer_folder = std::string(source_folder()) + "/src/viewer/dist";
  command->add_option("--viewer", o->trainer.viewer_folder, "Folder of the built viewer")->capture_default_str();
  add_root(*command, o->common);
  command->callback([o, &action] { action.run = [o](const Streams& io) { return run(*o, io); }; });
}

}  // namespace filum
