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
  /// It does not answer, for example unplugged. It is opened again by itself as soon as it answers,
  /// and wrenches are rendered again. Another device under its name is not opened: last_fault()
  /// names both. A board that was without power while its grip was beside the centre stays lost,
  /// too, and its last_fault() begins with "counter jump": hold the grip at the centre, close the
  /// device and open it anew.
  kLost,
};

/// What a device can do.
struct Capabilities {
  bool force_x = false;  ///< it exerts a force to the right and to the left
  bool force_y = false;  ///< upwards and downwards
  bool force_z = false;  ///< towards the viewer and away
  bool torque = false;   ///< about all three axes
  /// False for a gamepad that only rumbles: it renders the size of a force.
  bool direction = false;
  double largest_force_N = 0;    ///< largest limit that set_limits() takes, N
  double largest_torque_Nm = 0;  ///< the same for torques, N m; of little use without `torque`
  /// Largest stiffness of a wall that was measured to be stable in a hand, N/m, with the lag of the
  /// drives that the profile has; small while nobody has measured that (docs/touch.md).
  double largest_stiffness_N_m = 0;
  double rate_Hz = 0;  ///< forces a second, at most
  /// Width, height and depth of the box around the centre that the grip is to stay in, m, and that
  /// a stick covers; 0 where its position is not measured.
  Vector3 workspace_m;
  int buttons = 0;  ///< how many Device::buttons() reports, at most 32
};

/// A relief that the grip touches from the front: the element's property `touch`.
struct Surface {
  /// How near each position is: 255 is nearest. The picture covers the width and height of the
  /// workspace (Capabilities::workspace_m), whatever its proportions are.
  GreyPicture picture;
  /// Height of the relief from 0 to 255, m, at most 0.03. Its middle, 127.5, is in the middle of
  /// the workspace. Slopes are limited to 1.5.
  double relief_m = 0.008;
  /// Stiffness, N/m, above 0 and at most Capabilities::largest_stiffness_N_m.
  double stiffness_N_m = 200;
  double friction = 0.3;  ///< coefficient of static friction; that of kinetic friction is 0.8 of it
  double texture = 0;  ///< how strongly the finest detail is rendered as force to the side; 0: not
};

/// Where the grip is in a tick, and how it moves.
struct GripState {
  Pose pose;                       ///< from the last exchange with the device
  Vector3 velocity_m_s;            ///< about 3 ms ago
  Vector3 angular_velocity_rad_s;  ///< about the axes of the device, about 3 ms ago
  double interval_s = 0;           ///< since the last tick
  std::uint32_t buttons = 0;       ///< as Device::buttons()
};

/// How much energy a callback may give to the hand.
enum class Energy {
  /// No more than the hand has put in since the callback last returned no force: a wall or a spring
  /// that is too stiff for the delay of the device becomes weaker instead of shaking. There is no
  /// torque, and no force pushes a hand that rests.
  kPassive,
  kAny,  ///< no bound but the limits of every wrench
};

/// An open device. A thread of its own drives it a thousand times a second, through the same limits
/// and checks as the GStreamer element (docs/safety.md): a wrench is limited, so is its rate of
/// change, and with no new wrench the device ramps to rest. A separate process,
/// spidar-guardian, zeroes the motors of a real board if this process dies.
///
/// All functions are for any thread: the library makes the calls that change something one after
/// another. Moving and destroying the object are not: nothing else may run on it then.
///
/// Within a callback, of this device or another, these throw std::logic_error, because they might
/// wait: push(), set_callback(), set_limits(), set_surface(), wait_until_running().
///
/// After fork(), the device stays with the parent: in the child it is kLost, and what would change
/// it throws std::runtime_error.
class GST_SPIDAR_API Device {
 public:
  /// How long a wrench holds: a program that hangs does not keep pulling.
  static constexpr std::chrono::milliseconds kHold{100};

  /// Opens the device called `name`, as the element's property `device` does: "sim" is the
  /// simulated SPIDAR, "usb" a board on USB, "ff" a force-feedback joystick, and list_devices()
  /// finds more. `profile` is its geometry and motors: a name of list_profiles(), the path of a
  /// .toml file, or empty for a device that needs none: a simulated one, or one without strings.
  ///
  /// Throws std::runtime_error, which says what is wrong and what to do, when there is no such
  /// device or profile, when a board needs a profile (it lists those that fit), or when the device
  /// cannot be opened.
  explicit Device(const std::string& name, const std::string& profile = {});
  /// Ramps the motors to zero and closes the device; takes about 60 ms.
  ~Device();
  /// `other` may only be destroyed or assigned to afterwards.
  Device(Device&& other) noexcept;
  /// Closes the device that was open; `other` may only be destroyed or assigned to afterwards.
  Device& operator=(Device&& other) noexcept;

  /// The wrench that is wanted from now on, for kHold or until the next call: call it again before
  /// kHold is over, at any rate up to 1 kHz, or the device ramps to rest. A wrench fades in, and
  /// out, over 40 ms at most, and the limits of its rate of change hold.
  ///
  /// False when the device takes no wrench at present, because it is lost. Throws
  /// std::invalid_argument when a number is not finite.
  bool push(const Wrench& wrench);

  /// Computes the wrench of a tick, within that tick.
  using Callback = std::function<Wrench(const GripState&)>;

  /// Calls `callback` once a millisecond in the thread that drives the device, whenever pose() is
  /// known, and adds its wrench to what is pushed: for walls and springs, which must follow the
  /// hand without delay. It must return within 0.5 ms, and neither allocate, lock nor wait. A
  /// wrench that is not finite counts as none. A callback that throws, or is late twenty times in a
  /// row, is not called again, and callback_error() says why. An empty one removes the previous
  /// one. If a callback never returns, the guardian sets a real board to rest after 50 ms.
  ///
  /// When this returns, the previous callback has ended.
  void set_callback(Callback callback, Energy energy = Energy::kPassive);

  /// Why the callback is not called any more; empty while it is, and when there is none.
  std::string callback_error() const;

  /// Forgets all wrenches: the device ramps to rest, which takes 40 ms.
  void rest();

  /// Limits the total force (3 N at first) and the total torque (0.1 N m at first) of whatever is
  /// pushed. From the next millisecond on, what exceeds them falls by 300 N and 10 N m a second.
  /// Throws std::invalid_argument unless both are finite and not negative, and the profile's
  /// strings can give them in every direction and about every axis without throwing a grip that a
  /// hand lets go of, or they are at most the initial limits.
  void set_limits(double max_force_N, double max_torque_Nm);

  /// Lets the grip touch a surface, until another one or clear_surface(). Its force is added to
  /// what is pushed, and yields no energy (docs/touch.md), except that a surface that appears in
  /// front of the grip lifts it, by 40 mm/s at most. `surface.picture` is not needed afterwards.
  ///
  /// False when the device takes no surface at present, because it is lost. Throws
  /// std::invalid_argument when a setting is out of range, for a picture that
  /// MotionToWrench::analyze() would refuse, and for a device that takes no force towards the
  /// viewer.
  bool set_surface(const Surface& surface);

  /// Removes the surface: nothing is touched any more.
  void clear_surface();

  /// Where the grip is. Nothing while that is not known: just after opening, and while the readings
  /// of the device do not fit together.
  std::optional<Pose> pose() const;

  /// The buttons that are pressed: the lowest bit is the first button, in the order of the kernel's
  /// joystick driver. None for a device without buttons, or while it is lost.
  std::uint32_t buttons() const;

  /// How fast the grip moves, m/s, about 3 ms ago. Nothing while pose() is not known.
  std::optional<Vector3> velocity() const;

  /// False while the force fades, rests or returns because nobody seems to hold the grip: it moved,
  /// spun or rested as only a released one does (docs/safety.md).
  bool held() const;

  /// Fraction of the wanted wrench that may be exerted. It is 1 unless the force has shaken the
  /// hand for long: the vibration of a day is limited (docs/safety.md).
  double vibration_fraction() const;

  /// The wrench that is commanded to the grip at present, after all limits, from the first
  /// millisecond on: a device that is kOpening already pulls. Zero while it is kLost, and when its
  /// motors are off. Parts that the device cannot exert are zero: torques and the force towards the
  /// viewer (z) on joysticks, wheels, gamepads and the SPIDAR-mouse, and the vertical force (y) on
  /// wheels. A gamepad that only rumbles renders the size of this force, not its direction.
  Wrench felt() const;

  /// What the device is doing.
  DeviceState state() const;

  /// Waits until the state is kRunning and the pose is known, for at most `timeout`. False when
  /// that is over.
  bool wait_until_running(std::chrono::milliseconds timeout) const;

  /// The last fault of the link to the device, for people, for example "unplugged"; empty when
  /// there has been none. While the state is kLost, it is the reason.
  std::string last_fault() const;

  /// What is not as it should be although the device works, for people; empty if all is well. For
  /// example, how much this user's hand was shaken today is not known, so that half of what is
  /// allowed counts as used.
  std::string warning() const;

  /// What the device can do.
  Capabilities capabilities() const;

  /// What was opened, for people, for example "sim". Valid while the device is open.
  const std::string& name() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Names for Device(): what is plugged in, then the simulated ones. Opens nothing.
GST_SPIDAR_API std::vector<std::string> list_devices();

/// Names of the profiles that Device() accepts, sorted.
GST_SPIDAR_API std::vector<std::string> list_profiles();

}  // namespace v0
}  // namespace gst_spidar
