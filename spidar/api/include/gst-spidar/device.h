// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// \file
/// A haptic device, real or simulated: push its grip and read where it is.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gst-spidar/export.h>
#include <gst-spidar/picture.h>
#include <gst-spidar/wrench.h>

namespace gst_spidar {
inline namespace v0 {

/// What an open device is doing.
enum class DeviceState {
  kOpening,  ///< the strings are being tightened, which takes 0.2 s
  kRunning,  ///< wrenches are rendered
  kIdle,     ///< no force was wanted for minutes and the motors are off; a wrench wakes it
  /// The device does not answer, for example because it is unplugged. The library opens the device
  /// again as soon as it answers, and renders wrenches again. The library does not open another
  /// device that has the same name: last_fault() names both. A board that was without power while
  /// its grip was beside the centre stays lost, too, and its last_fault() begins with "counter
  /// jump": hold the grip at the centre, close the device and open it anew.
  kLost,
};

/// What a device can do.
struct Capabilities {
  bool force_x = false;  ///< it exerts a force to the right and to the left
  bool force_y = false;  ///< upwards and downwards
  bool force_z = false;  ///< towards the viewer and away
  bool torque = false;   ///< about all three axes
  /// False for a gamepad that only rumbles: such a gamepad renders the magnitude of a force.
  bool direction = false;
  double largest_force_N = 0;    ///< largest force that set_limits() takes, N
  double largest_torque_Nm = 0;  ///< largest torque that set_limits() takes, N m
  /// The largest stiffness of a wall that was measured to be stable in a hand, N/m, with the lag of
  /// the drives that the profile states. The value is small for devices that nobody has measured
  /// (docs/touch.md).
  double largest_stiffness_N_m = 0;
  double rate_Hz = 0;  ///< the most forces that the device takes in a second
  /// Width, height and depth of the box around the centre in which the grip must stay, m. For a
  /// stick, the box is what the stick covers. 0 where the device does not measure its position.
  Vector3 workspace_m;
  int buttons = 0;  ///< how many Device::buttons() reports, at most 32
};

/// A relief that the grip touches from the front: the element's property `touch`.
struct Surface {
  /// How near each position is: 255 is nearest. The picture covers the width and height of the
  /// workspace (Capabilities::workspace_m), whatever the proportions of the picture are.
  GreyPicture picture;
  /// Height of the relief from 0 to 255, m, at most 0.03. The value 127.5 lies in the middle of the
  /// workspace. Slopes are limited to 1.5.
  double relief_m = 0.008;
  /// Stiffness, N/m, above 0 and at most Capabilities::largest_stiffness_N_m.
  double stiffness_N_m = 200;
  double friction = 0.3;  ///< coefficient of static friction; the kinetic one is 0.8 times as large
  double texture = 0;     ///< how strongly the finest detail becomes a lateral force; 0: not at all
};

/// Where the grip is in a tick of the loop, and how the grip moves.
struct GripState {
  Pose pose;                       ///< from the last exchange with the device
  Vector3 velocity_m_s;            ///< about 3 ms ago
  Vector3 angular_velocity_rad_s;  ///< about the axes of the device, about 3 ms ago
  double interval_s = 0;           ///< since the last tick
  std::uint32_t buttons = 0;       ///< the same as Device::buttons()
};

/// How much energy a callback may give to the hand.
enum class Energy {
  /// The callback gives no more energy than the hand has put in since the callback last returned no
  /// force: a wall or a spring that is too stiff for the delay of the device becomes weaker instead
  /// of shaking. Torques are dropped, and no force pushes a hand that rests.
  kPassive,
  kAny,  ///< only the limits of every wrench apply
};

/// An open device. A thread of its own drives the device a thousand times a second, through the
/// same limits and checks as the GStreamer element (docs/safety.md): the wrench and its rate of
/// change are limited, and without a new wrench the device ramps to rest. A separate process,
/// spidar-guardian, sets the motors of a real board to zero if this process dies.
///
/// Every function may be called in any thread: the library runs the calls that change something one
/// after another. While the object is being moved or destroyed, no other call may run.
///
/// Within a callback of any device, push(), set_callback(), set_limits(), set_surface() and
/// wait_until_running() throw std::logic_error, because they might wait.
///
/// After fork(), the device stays with the parent. In the child its state is kLost, and every call
/// that would change something throws std::runtime_error.
class GST_SPIDAR_API Device {
 public:
  /// How long a wrench lasts, so that a program that hangs does not keep pulling.
  static constexpr std::chrono::milliseconds kHold{100};

  /// Opens the device called `name`, as the element's property `device` does: "sim" is the
  /// simulated SPIDAR, "usb" a board on USB, "ff" a force-feedback joystick; list_devices() finds
  /// more. `profile` names the geometry and the motors: a name of list_profiles(), the path of a
  /// .toml file, or an empty string for a device that needs no profile, which is a simulated one or
  /// one without strings.
  ///
  /// Throws std::runtime_error when there is no such device or profile, when a board needs a
  /// profile, or when the device cannot be opened. The error says what is wrong and what to do, and
  /// lists the profiles that fit.
  explicit Device(const std::string& name, const std::string& profile = {});
  /// Ramps the motors to zero and closes the device, which takes about 60 ms.
  ~Device();
  /// Afterwards, `other` may only be destroyed or assigned to.
  Device(Device&& other) noexcept;
  /// Closes the device that was open. Afterwards, `other` may only be destroyed or assigned to.
  Device& operator=(Device&& other) noexcept;

  /// Sets the wanted wrench for kHold or until the next call. Call push() again before kHold is
  /// over, at any rate up to 1 kHz, or the device ramps to rest. A wrench fades in and out within
  /// 40 ms at most, and the limits of its rate of change apply.
  ///
  /// Returns false when the device accepts no wrench at present because it is lost. Throws
  /// std::invalid_argument when a number is not finite.
  bool push(const Wrench& wrench);

  /// Computes the wrench of a tick, within that tick.
  using Callback = std::function<Wrench(const GripState&)>;

  /// Calls `callback` once a millisecond in the thread that drives the device, whenever pose() is
  /// known, and adds the returned wrench to the pushed one. Callbacks are for walls and springs,
  /// which must follow the hand without delay. A callback must return within 0.5 ms, and must not
  /// allocate, lock or wait. A returned wrench that is not finite counts as none. A callback that
  /// throws, or is late twenty times in a row, is not called again, and callback_error() says why.
  /// An empty callback removes the previous one. If a callback never returns, the guardian sets a
  /// real board to rest after 50 ms.
  ///
  /// The previous callback has ended when this function returns.
  void set_callback(Callback callback, Energy energy = Energy::kPassive);

  /// Why the callback is no longer called; empty while the library calls it, and when there is
  /// none.
  std::string callback_error() const;

  /// Discards all wrenches: the device ramps to rest, which takes 40 ms.
  void rest();

  /// Limits the total force (3 N at first) and the total torque (0.1 N m at first) of everything
  /// that is pushed. From the next millisecond on, the excess falls by 300 N and 10 N m a second.
  /// Both limits must be finite and not negative. Limits above the initial ones must also be such
  /// that the profile's strings can exert them in every direction and about every axis, and do not
  /// throw a grip that a hand releases. Otherwise throws std::invalid_argument.
  void set_limits(double max_force_N, double max_torque_Nm);

  /// Lets the grip touch a surface until another call sets a new surface, or clear_surface()
  /// removes it. The force of the surface is added to the pushed one and yields no energy
  /// (docs/touch.md); only a surface that appears in front of the grip lifts the grip, by 40 mm/s
  /// at most. `surface.picture` is not needed afterwards.
  ///
  /// Returns false when the device accepts no surface at present because it is lost. Throws
  /// std::invalid_argument when a setting is out of range, for a picture that
  /// MotionToWrench::analyze() would refuse, and for a device that takes no force towards the
  /// viewer.
  bool set_surface(const Surface& surface);

  /// Removes the surface.
  void clear_surface();

  /// Returns the pose of the grip, or nothing while the pose is unknown: just after opening, and
  /// while the readings of the device contradict each other.
  std::optional<Pose> pose() const;

  /// Returns the pressed buttons: the lowest bit is the first button, in the order of the kernel's
  /// joystick driver. Returns 0 for a device without buttons, and while the device is lost.
  std::uint32_t buttons() const;

  /// Returns the velocity of the grip about 3 ms ago, m/s, or nothing while pose() is unknown.
  std::optional<Vector3> velocity() const;

  /// False while the force rests or returns because nobody seems to hold the grip: it has moved
  /// faster than a hand for 70 ms, or turned by more than 100° (docs/safety.md).
  bool held() const;

  /// The fraction of the wanted wrench that may be exerted. The fraction is 1 until the force has
  /// shaken the hand for long: the vibration of a day is limited (docs/safety.md).
  double vibration_fraction() const;

  /// The wrench that is commanded to the grip at present, after all limits, from the first
  /// millisecond on: a device that is kOpening already pulls. The wrench is zero while the state is
  /// kLost and while the motors are off. Parts that the device cannot exert are zero: torques and
  /// the force towards the viewer (z) on joysticks, wheels, gamepads and the SPIDAR-mouse, and the
  /// vertical force (y) on wheels. A gamepad that only rumbles renders the magnitude of this force,
  /// not its direction.
  Wrench felt() const;

  /// What the device is doing.
  DeviceState state() const;

  /// Waits until the state is kRunning and the pose is known, for at most `timeout`. Returns false
  /// when the time is over.
  bool wait_until_running(std::chrono::milliseconds timeout) const;

  /// The last fault of the link to the device, for people, for example "unplugged"; empty when
  /// there has been none. While the state is kLost, this fault is the reason.
  std::string last_fault() const;

  /// A warning about a device that works, but not as it should, for people; empty if all is well.
  /// For example, the library does not know how much this user's hand was shaken today, and counts
  /// half of the permitted vibration as used.
  std::string warning() const;

  /// What the device can do.
  Capabilities capabilities() const;

  /// The name of the open device, for people, for example "sim". Valid while the device is open.
  const std::string& name() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Names for Device(): first what is plugged in, then the simulated devices. Opens nothing.
GST_SPIDAR_API std::vector<std::string> list_devices();

/// Names of the profiles that Device() accepts, sorted.
GST_SPIDAR_API std::vector<std::string> list_profiles();

}  // namespace v0
}  // namespace gst_spidar
