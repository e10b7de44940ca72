#include "spidar/tools/calibrate_options.h"

#include <cmath>
#include <cstdlib>
#include <getopt.h>
#include <sstream>
#include <vector>

#include <Eigen/Geometry>

namespace spidar {

const char* const kCalibrateHelp =
    R"(usage: spidarctl calibrate DEVICE [OPTION]...

Finds the string lengths at which the encoders of DEVICE are zero.

  --profile NAME        profile of the device, a name or a file (default spidar-gcc)
  --move SECONDS        from a grip that you move and turn in every direction (default, 20)
  --centre              from a grip that you hold still at the centre, not turned
  --free exits,scale    with --move, also find where the strings leave the frame, and a factor
                        on every metres_per_count
  --output FILE.toml    write the calibrated profile
  --json                report as JSON
  --sim-start X,Y,Z,RX,RY,RZ
                        simulated device: its counters were cleared there, off the centre by
                        X,Y,Z millimetres and turned by RX,RY,RZ degrees (a rotation vector)
  --help

The strings are held taut, nothing else pushes the hand. Exit status: 0 calibrated, 1 no device,
profile or file, 2 wrong usage, 3 the samples do not determine what was asked for or contradict
the profile (nothing is written), 130 interrupted.
)";

namespace {

enum Option { kProfile = 1, kMove, kCentre, kFree, kOutput, kJson, kSimStart, kHelp };

constexpr double kMinSeconds = 1;
constexpr double kMaxSeconds = 600;

std::vector<std::string> parts_of(const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, ',');) parts.push_back(part);
  return parts;
}

double number(const std::string& option, const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(value))
    throw UsageError(option + ": \"" + text + "\" is not a number");
  return value;
}

double seconds(const std::string& text) {
  const double value = number("--move", text);
  if (!(value >= kMinSeconds && value <= kMaxSeconds))
    throw UsageError("--move: " + text + " s, must be from 1 to 600 s");
  return value;
}

CalibrationSettings free_parameters(const std::string& text) {
  CalibrationSettings settings;
  for (const std::string& part : parts_of(text)) {
    if (part != "exits" && part != "scale")
      throw UsageError("--free: \"" + part + "\" is unknown; known are exits, scale");
    (part == "exits" ? settings.free_exits : settings.free_scale) = true;
  }
  return settings;
}

Pose start_pose(const std::string& text) {
  const std::vector<std::string> parts = parts_of(text);
  if (parts.size() != 6)
    throw UsageError("--sim-start: \"" + text +
                     "\" must be six numbers: X,Y,Z in millimetres, RX,RY,RZ in degrees");
  Eigen::Matrix<double, 6, 1> value;
  for (size_t i = 0; i < 6; ++i)
    value[static_cast<Eigen::Index>(i)] = number("--sim-start", parts[i]);
  Pose pose;
  pose.position_m = 1e-3 * value.head<3>();
  const Eigen::Vector3d turn = M_PI / 180 * value.tail<3>();
  if (turn.norm() > 0) pose.orientation = Eigen::AngleAxisd(turn.norm(), turn.normalized());
  return pose;
}

std::string output_file(const std::string& text) {
  const std::string ending = ".toml";
  if (text.size() <= ending.size() ||
      text.compare(text.size() - ending.size(), ending.size(), ending) != 0)
    throw UsageError("--output: \"" + text + "\" must end in .toml, as profile files do");
  return text;
}

void check_together(const CalibrateOptions& options, bool moving) {
  if (options.centre && moving) throw UsageError("--centre and --move: one of them");
  if (options.centre && (options.settings.free_exits || options.settings.free_scale))
    throw UsageError("--free needs --move: a grip that is held still tells nothing but offsets");
  if (options.sim_start && options.device != "sim")
    throw UsageError("--sim-start is for the device sim, not " + options.device);
}

}  // namespace

CalibrateOptions parse_calibrate_options(int argc, char** argv) {
  static const option kLong[] = {{"profile", required_argument, nullptr, kProfile},
                                 {"move", required_argument, nullptr, kMove},
                                 {"centre", no_argument, nullptr, kCentre},
                                 {"free", required_argument, nullptr, kFree},
                                 {"output", required_argument, nullptr, kOutput},
                                 {"json", no_argument, nullptr, kJson},
                                 {"sim-start", required_argument, nullptr, kSimStart},
                                 {"help", no_argument, nullptr, kHelp},
                                 {}};
  CalibrateOptions options;
  bool moving = false;
  opterr = 0;
  optind = 1;
  for (int found; (found = getopt_long(argc, argv, ":", kLong, nullptr)) != -1;) {
    switch (found) {
      case kProfile:
        options.profile = optarg;
        break;
      case kMove:
        options.seconds = seconds(optarg);
        moving = true;
        break;
      case kCentre:
        options.centre = true;
        break;
      case kFree:
        options.settings = free_parameters(optarg);
        break;
      case kOutput:
        options.output = output_file(optarg);
        break;
      case kJson:
        options.json = true;
        break;
      case kSimStart:
        options.sim_start = start_pose(optarg);
        break;
      case kHelp:
        options.help = true;
        return options;
      case ':':
        throw UsageError(std::string(argv[optind - 1]) + " needs a value");
      default:
        throw UsageError(std::string(argv[optind - 1]) + " is not an option");
    }
  }
  if (optind + 1 != argc)
    throw UsageError(optind >= argc ? "no DEVICE given; see spidarctl list"
                                    : std::string(argv[optind + 1]) + ": one DEVICE only");
  options.device = argv[optind];
  check_together(options, moving);
  return options;
}

}  // namespace spidar
