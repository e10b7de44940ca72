/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Copyright 2026 the gst-spidar authors */
/*! \file
 * device.h and motion.h in C, for programs in C and for languages that call C (Python's ctypes and
 * cffi, Julia, Rust, C#, …).
 *
 * The last argument of a function that can fail is a GstSpidarError. It may be NULL; otherwise each
 * call sets it, even when all is well. No other pointer may be NULL unless that is stated. No
 * function throws a C++ exception. Coordinates are those of wrench.h: right-handed, x right, y up,
 * z towards the viewer. */
#ifndef GST_SPIDAR_C_API_H
#define GST_SPIDAR_C_API_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <gst-spidar/export.h>

#ifdef __cplusplus
extern "C" {
#endif

/*! The kind of an error. */
typedef enum {
  GST_SPIDAR_OK = 0,             /*!< none */
  GST_SPIDAR_ERROR_ARGUMENT = 1, /*!< an argument is wrong; nothing has changed */
  GST_SPIDAR_ERROR_FAILED = 2,   /*!< all else, such as a device that cannot be opened */
  GST_SPIDAR_ERROR_LOST = 3      /*!< the device accepts no wrench at present; try again later */
} GstSpidarErrorKind;

/*! An error. The caller owns it; there is nothing to free. */
typedef struct {
  GstSpidarErrorKind kind; /*!< which kind; GST_SPIDAR_OK when all is well */
  /*! One sentence in UTF-8 that says what was wrong and what would be right; empty when all is
   * well. */
  char message[1020];
} GstSpidarError;

/*! Three coordinates, in the unit that the name of the variable ends in. */
typedef struct {
  double x; /*!< to the right; for a torque, about this axis, right-handed */
  double y; /*!< upwards */
  double z; /*!< towards the viewer */
} GstSpidarVector3;

/*! A rotation by an angle about an axis, as a quaternion of length 1. */
typedef struct {
  double w; /*!< cosine of half the angle; 1 for no rotation */
  double x; /*!< x of the axis, a vector of length 1, times the sine of half the angle */
  double y; /*!< y of the axis times the same sine */
  double z; /*!< z of the axis times the same sine */
} GstSpidarQuaternion;

/*! Force on the grip, and torque about the grip's origin. */
typedef struct {
  GstSpidarVector3 force_N;   /*!< newtons */
  GstSpidarVector3 torque_Nm; /*!< newton metres */
} GstSpidarWrench;

/*! Where the grip is. */
typedef struct {
  GstSpidarVector3 position_m;     /*!< of its origin, metres from the centre of the workspace */
  GstSpidarQuaternion orientation; /*!< turns vectors of the grip's frame into the device's */
} GstSpidarPose;

/*! What an open device is doing. */
typedef enum {
  GST_SPIDAR_OPENING = 0, /*!< the strings are being tightened, which takes 0.2 s */
  GST_SPIDAR_RUNNING = 1, /*!< wrenches are felt */
  GST_SPIDAR_IDLE = 2,    /*!< no force was wanted for minutes: motors off; a wrench wakes it */
  GST_SPIDAR_LOST = 3     /*!< does not answer; opened again as soon as it does (docs/api.md) */
} GstSpidarState;

/*! What a device can do. */
typedef struct {
  bool force_x;   /*!< it exerts a force to the right and to the left */
  bool force_y;   /*!< upwards and downwards */
  bool force_z;   /*!< towards the viewer and away */
  bool torque;    /*!< about all three axes */
  bool direction; /*!< false for a gamepad that only rumbles: only the magnitude is rendered */
  double largest_force_N;   /*!< largest limit that gst_spidar_device_set_limits() accepts, N */
  double largest_torque_Nm; /*!< the same for torques, N m; of little use without `torque` */
  /*! Largest stiffness of a wall that was measured to be stable in a hand, N/m. */
  double largest_stiffness_N_m;
  double rate_Hz; /*!< forces a second, at most */
  /*! Width, height and depth of the box around the centre that the grip is to stay in, m, and that
   * a stick covers; 0 where its position is not measured. */
  GstSpidarVector3 workspace_m;
  int buttons; /*!< how many gst_spidar_device_buttons() reports, at most 32 */
} GstSpidarCapabilities;

/*! A grey picture: `height` rows of `width` bytes, 0 black and 255 white. The memory is the
 * caller's; it is only read, and only during the call. */
typedef struct {
  const uint8_t* data; /*!< first pixel of the top row */
  int width;           /*!< px, at least 16 */
  int height;          /*!< px, at least 16 */
  ptrdiff_t stride;    /*!< bytes from one row to the next, at least `width` */
} GstSpidarPicture;

/*! A relief that the grip touches from the front. Usual values are in brackets. */
typedef struct {
  /*! How near each position is: 255 is nearest. The picture covers the width and height of the
   * workspace. */
  GstSpidarPicture picture;
  double relief_m; /*!< from 0 to 255, m, at most 0.03 [0.008]; its middle is the workspace's */
  double stiffness_N_m; /*!< N/m, above 0, at most that of the capabilities [200] */
  double friction;      /*!< coefficient of static friction [0.3]; 0.8 of it is the kinetic one */
  double texture;       /*!< how strongly the finest detail becomes a lateral force [0] */
} GstSpidarSurface;

/*! Where the grip is in a tick, and how it moves. */
typedef struct {
  GstSpidarPose pose;                      /*!< from the last exchange with the device */
  GstSpidarVector3 velocity_m_s;           /*!< about 3 ms ago */
  GstSpidarVector3 angular_velocity_rad_s; /*!< about the axes of the device, about 3 ms ago */
  double interval_s;                       /*!< since the last tick */
  uint32_t buttons;                        /*!< as gst_spidar_device_buttons() */
} GstSpidarGripState;

/*! How much energy a callback may give to the hand. */
typedef enum {
  /*! No more than the hand has put in since the callback last returned no force, and no torque: for
   * walls and springs, which then cannot shake. */
  GST_SPIDAR_PASSIVE = 0,
  GST_SPIDAR_ANY = 1 /*!< no bound but the limits of every wrench */
} GstSpidarEnergy;

/*! An open device: gst_spidar::Device. All functions may be called in any thread: the library runs
 * the calls that change something one after another. Only gst_spidar_device_close() must not run at
 * the same time as another call.
 *
 * Within a callback, of this device or another, these fail with GST_SPIDAR_ERROR_FAILED, because
 * they might wait: push, set_callback, set_limits, set_surface; wait_until_running returns false.
 *
 * After fork(), the device stays with the parent: in the child it is lost.
 */
typedef struct GstSpidarDevice GstSpidarDevice;

/*! Opens the device called `name`: "sim" is the simulated SPIDAR, "usb" a board on USB, "ff" a
 * force-feedback joystick, and gst_spidar_list_devices() finds more. `profile` is its geometry and
 * motors: a name of gst_spidar_list_profiles(), the path of a .toml file, or NULL or empty for a
 * device that needs none: a simulated one, or one without strings. Returns NULL on failure. */
GST_SPIDAR_API GstSpidarDevice* gst_spidar_device_open(const char* name, const char* profile,
                                                       GstSpidarError* error);

/*! Ramps the motors to zero, closes the device and frees it; takes about 60 ms. When it returns,
 * the callback has ended. NULL does nothing. Not to be called within a callback. */
GST_SPIDAR_API void gst_spidar_device_close(GstSpidarDevice* device);

/*! Sets the wanted wrench for 100 ms or until the next call. Call it again before that, at any rate
 * up to 1 kHz, or the device ramps to rest. Returns false with GST_SPIDAR_ERROR_LOST when the
 * device accepts no wrench at present, and with GST_SPIDAR_ERROR_ARGUMENT when a number is not
 * finite. */
GST_SPIDAR_API bool gst_spidar_device_push(GstSpidarDevice* device, const GstSpidarWrench* wrench,
                                           GstSpidarError* error);

/*! Discards all wrenches: the device ramps to rest, which takes 40 ms. */
GST_SPIDAR_API void gst_spidar_device_rest(GstSpidarDevice* device);

/*! Computes the wrench of a tick, within that tick. `wrench` is initially zero. Returning false
 * ends the calls, and gst_spidar_device_callback_error() then says so. Must not throw. */
typedef bool (*GstSpidarCallback)(const GstSpidarGripState* grip, GstSpidarWrench* wrench,
                                  void* user_data);

/*! Calls `callback` once a millisecond in the thread that drives the device, whenever the pose is
 * known, and adds its wrench to the pushed one. The callback must return within 0.5 ms, and neither
 * allocate, lock nor wait. A wrench that is not finite counts as none. A callback that returns
 * false, or is late twenty times in a row, is not called again; NULL removes it. When this returns,
 * the previous callback has ended. Returns false if that fails; the previous callback remains. */
GST_SPIDAR_API bool gst_spidar_device_set_callback(GstSpidarDevice* device,
                                                   GstSpidarCallback callback, void* user_data,
                                                   GstSpidarEnergy energy, GstSpidarError* error);

/*! Writes why the callback is no longer called to `text` of `size` bytes, as snprintf() does:
 * shortened when it does not fit, and nothing when `size` is 0. Returns the full length in bytes; 0
 * while the callback is called and when there is none. */
GST_SPIDAR_API size_t gst_spidar_device_callback_error(const GstSpidarDevice* device, char* text,
                                                       size_t size);

/*! Limits the total force (3 N at first) and the total torque (0.1 N m at first) of everything that
 * is pushed. Returns false with GST_SPIDAR_ERROR_ARGUMENT for limits that the device does not
 * accept; the message states the largest ones. */
GST_SPIDAR_API bool gst_spidar_device_set_limits(GstSpidarDevice* device, double max_force_N,
                                                 double max_torque_Nm, GstSpidarError* error);

/*! Lets the grip touch a surface, until the next call or gst_spidar_device_clear_surface(). The
 * surface's force is added to the pushed one, and yields no energy, except that a surface that
 * appears in front of the grip lifts it, by 40 mm/s at most. The picture is not needed afterwards.
 * Returns false with GST_SPIDAR_ERROR_LOST when the device accepts no surface at present, and with
 * GST_SPIDAR_ERROR_ARGUMENT when a setting is out of range, or the device exerts no force towards
 * the viewer. */
GST_SPIDAR_API bool gst_spidar_device_set_surface(GstSpidarDevice* device,
                                                  const GstSpidarSurface* surface,
                                                  GstSpidarError* error);

/*! Removes the surface: nothing is touched any more. */
GST_SPIDAR_API void gst_spidar_device_clear_surface(GstSpidarDevice* device);

/*! Gets the pose of the grip. Returns false and leaves `pose` unchanged while it is unknown. */
GST_SPIDAR_API bool gst_spidar_device_pose(const GstSpidarDevice* device, GstSpidarPose* pose);

/*! Gets the velocity of the grip about 3 ms ago, m/s. Returns false and leaves `velocity_m_s`
 * unchanged while the pose is unknown. */
GST_SPIDAR_API bool gst_spidar_device_velocity(const GstSpidarDevice* device,
                                               GstSpidarVector3* velocity_m_s);

/*! Returns the pressed buttons: the lowest bit is the first button, in the order of the kernel's
 * joystick driver. Returns 0 for a device without buttons, and while the device is lost. */
GST_SPIDAR_API uint32_t gst_spidar_device_buttons(const GstSpidarDevice* device);

/*! False while the force rests or returns because nobody seems to hold the grip. */
GST_SPIDAR_API bool gst_spidar_device_held(const GstSpidarDevice* device);

/*! Returns the fraction of the wanted wrench that may be exerted: 1 unless the force has shaken the
 * hand for long. */
GST_SPIDAR_API double gst_spidar_device_vibration_fraction(const GstSpidarDevice* device);

/*! Gets the wrench that is commanded at present, after all limits: Device::felt(). */
GST_SPIDAR_API void gst_spidar_device_felt(const GstSpidarDevice* device, GstSpidarWrench* wrench);

/*! What the device is doing. */
GST_SPIDAR_API GstSpidarState gst_spidar_device_state(const GstSpidarDevice* device);

/*! Waits until the state is GST_SPIDAR_RUNNING and the pose is known, for at most `timeout_ms`.
 * Returns false when that time is over. */
GST_SPIDAR_API bool gst_spidar_device_wait_until_running(const GstSpidarDevice* device,
                                                         int64_t timeout_ms);

/*! The last fault of the link to the device, for example "unplugged", written as
 * gst_spidar_device_callback_error() does; length 0 when there has been none. */
GST_SPIDAR_API size_t gst_spidar_device_last_fault(const GstSpidarDevice* device, char* text,
                                                   size_t size);

/*! A warning about a device that works, but not as it should, written as
 * gst_spidar_device_callback_error() does; length 0 if all is well: Device::warning(). */
GST_SPIDAR_API size_t gst_spidar_device_warning(const GstSpidarDevice* device, char* text,
                                                size_t size);

/*! What the device can do. */
GST_SPIDAR_API void gst_spidar_device_capabilities(const GstSpidarDevice* device,
                                                   GstSpidarCapabilities* capabilities);

/*! The name of the open device, for people, for example "sim". Valid while the device is open. */
GST_SPIDAR_API const char* gst_spidar_device_name(const GstSpidarDevice* device);

/*! Names for gst_spidar_device_open(): devices plugged in, then simulated ones. Opens nothing.
 * NULL follows the last name; free it with gst_spidar_free_list(). Returns NULL on failure. */
GST_SPIDAR_API char** gst_spidar_list_devices(GstSpidarError* error);

/*! Names of the profiles that gst_spidar_device_open() knows, sorted, in the same form. */
GST_SPIDAR_API char** gst_spidar_list_profiles(GstSpidarError* error);

/*! Frees a list with its names. NULL does nothing. */
GST_SPIDAR_API void gst_spidar_free_list(char** list);

/*! How speed becomes force: the element's property `controller`. */
typedef enum {
  GST_SPIDAR_LINEAR = 0,    /*!< proportional; the largest speed so far is the largest force */
  GST_SPIDAR_NONLINEAR = 1, /*!< an arc tangent of the speed */
  GST_SPIDAR_ADAPTIVE = 2   /*!< the same, following the scene; no force below the noise */
} GstSpidarController;

/*! Which motion is felt: the element's property `motion`. */
typedef enum {
  GST_SPIDAR_MEAN = 0,   /*!< of all points */
  GST_SPIDAR_OBJECT = 1, /*!< of the dominant object against the background */
  GST_SPIDAR_CAMERA = 2, /*!< of the camera */
  GST_SPIDAR_OBJECTS = 3 /*!< of all objects, weighted by area and nearness to the pointer */
} GstSpidarFeltMotion;

/*! What is felt, and how strongly. The initial values are in brackets. */
typedef struct {
  GstSpidarController controller; /*!< [GST_SPIDAR_NONLINEAR] */
  GstSpidarFeltMotion motion;     /*!< [GST_SPIDAR_OBJECT] */
  double max_force_N;             /*!< the largest force, finite and not negative [3] */
  /*! How quickly force rises with speed, except with GST_SPIDAR_LINEAR: half of the largest force
   * is reached at 1 / `alpha_s_px` px/s in a picture of 480 rows. Finite and not negative [0.0025].
   */
  double alpha_s_px;
  /*! Where GST_SPIDAR_OBJECTS is felt most, as a fraction of the picture's width from the left
   * [0.5]
   */
  double pointer_x;
  double pointer_y;  /*!< the same of its height, from the top [0.5] */
  double depth_gain; /*!< how strongly growth is felt as force towards the viewer; 0: not [1] */
  double roll_gain;  /*!< how strongly roll is felt as torque about that axis; 0: not [1] */
} GstSpidarMotionSettings;

/*! What was found in one picture. */
typedef struct {
  GstSpidarWrench wrench;  /*!< wanted, before the limits of a device; zero after a cut */
  double velocity_x_px_s;  /*!< of the motion that is felt, to the right */
  double velocity_y_px_s;  /*!< downwards */
  double growth_1_s;       /*!< relative change of lengths a second; positive comes nearer */
  double roll_rad_s;       /*!< clockwise as seen */
  bool has_picture_before; /*!< false: nothing to compare with, and everything above is zero */
} GstSpidarMotionResult;

/*! Measures the motion of pictures and computes the wrench: gst_spidar::MotionToWrench. All
 * functions may be called in any thread; only gst_spidar_motion_free() must not run during another
 * call. After fork(), the child must make its own object: functions on a copy fail. */
typedef struct GstSpidarMotion GstSpidarMotion;

/*! Gets the initial settings of a motion, so that a program can change some of them. */
GST_SPIDAR_API void gst_spidar_motion_settings_init(GstSpidarMotionSettings* settings);

/*! Makes an object with the settings of gst_spidar_motion_settings_init(). Returns NULL when memory
 * is short. */
GST_SPIDAR_API GstSpidarMotion* gst_spidar_motion_new(GstSpidarError* error);

/*! Frees the object. NULL does nothing. */
GST_SPIDAR_API void gst_spidar_motion_free(GstSpidarMotion* motion);

/*! Analyses the next picture, shown at `time_ns` on a clock of the caller's. A cut, or a time
 * that is not after the previous one, restarts the analysis with a wrench of zero. Returns false
 * and leaves `result` unchanged if the picture has no data, is below 16 × 16, or rows overlap. */
GST_SPIDAR_API bool gst_spidar_motion_analyze(GstSpidarMotion* motion,
                                              const GstSpidarPicture* picture, int64_t time_ns,
                                              GstSpidarMotionResult* result, GstSpidarError* error);

/*! Call this after a seek: the next picture has nothing to do with the previous one. */
GST_SPIDAR_API void gst_spidar_motion_reset(GstSpidarMotion* motion);

/*! Changes the settings from the next picture on. Returns false and changes nothing when one of the
 * settings is out of range. */
GST_SPIDAR_API bool gst_spidar_motion_configure(GstSpidarMotion* motion,
                                                const GstSpidarMotionSettings* settings,
                                                GstSpidarError* error);

#ifdef __cplusplus
}
#endif

#endif
