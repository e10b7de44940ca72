/// `spidarctl calibrate`.
#pragma once

namespace spidar {

/// `argv[0]` is the sub-command. Returns the exit status; throws UsageError, DeviceError,
/// ProfileError.
int calibrate_command(int argc, char** argv);

}  // namespace spidar
