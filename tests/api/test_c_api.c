/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Copyright 2026 the gst-spidar authors */
/* The interface in C, used as by other programs. Every number that crosses it is compared, so that
 * types whose members are in another order than those of C++ are noticed. */
#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <gst-spidar/c-api.h>

#define REQUIRE(holds) ((holds) ? (void)0 : fail(__LINE__, #holds))

static _Noreturn void fail(int line, const char* what) {
  fprintf(stderr, "line %d: not so: %s\n", line, what);
  exit(1);
}

/* A change here changes the binary interface and needs a new soname. */
_Static_assert(sizeof(GstSpidarError) == 1024, "size");
_Static_assert(sizeof(GstSpidarWrench) == 6 * sizeof(double), "size");
_Static_assert(sizeof(GstSpidarPose) == 7 * sizeof(double), "size");
_Static_assert(sizeof(GstSpidarMotionSettings) == 7 * sizeof(double), "size");
_Static_assert(sizeof(GstSpidarGripState) == 15 * sizeof(double), "size");

/* Events take milliseconds; the limit is generous for a busy machine. */
#define COMES_TRUE(what)                                         \
  do {                                                           \
    int tries = 0;                                               \
    while (!(what)) REQUIRE(++tries < 60000 && (wait_ms(1), 1)); \
  } while (0)

static void wait_ms(long ms) {
  const struct timespec time = {0, ms * 1000000};
  nanosleep(&time, NULL);
}

static void names_are_listed(void) {
  GstSpidarError error;
  char** const devices = gst_spidar_list_devices(&error);
  char** const profiles = gst_spidar_list_profiles(NULL);
  int sims = 0, grips = 0;
  REQUIRE(devices && profiles && error.kind == GST_SPIDAR_OK);
  for (char** name = devices; *name; ++name) sims += strcmp(*name, "sim") == 0;
  for (char** name = profiles; *name; ++name) grips += strcmp(*name, "spidar-g") == 0;
  REQUIRE(sims == 1 && grips == 1);
  gst_spidar_free_list(devices);
  gst_spidar_free_list(profiles);
  gst_spidar_free_list(NULL);
}

static void what_is_wrong_is_named(void) {
  GstSpidarError error;
  char long_name[2000];
  REQUIRE(!gst_spidar_device_open("nosuch", NULL, &error));
  REQUIRE(error.kind == GST_SPIDAR_ERROR_FAILED);
  REQUIRE(strstr(error.message, "unknown device \"nosuch\"; known are: sim"));
  REQUIRE(!gst_spidar_device_open(NULL, NULL, &error) && strstr(error.message, "unknown device"));
  REQUIRE(!gst_spidar_device_open("nosuch", NULL, NULL));
  REQUIRE(!gst_spidar_device_open("sim", "nosuch", &error));
  REQUIRE(strstr(error.message, "unknown profile \"nosuch\""));
  /* An error that does not fit, with characters of two bytes. */
  for (size_t i = 0; i < sizeof long_name - 2; i += 2) memcpy(long_name + i, "\u00e4", 2);
  long_name[sizeof long_name - 2] = '\0';
  REQUIRE(!gst_spidar_device_open(long_name, NULL, &error));
  {
    const size_t length = strlen(error.message), before = strlen("unknown device \"");
    REQUIRE(length >= sizeof error.message - 2 && length < sizeof error.message);
    REQUIRE((length - before) % 2 == 0);
  }
}

static void a_push_is_felt(GstSpidarDevice* device) {
  const GstSpidarWrench wanted = {{0.5, 0.25, -0.125}, {0, 0, 0.01}};
  GstSpidarWrench felt = {{0, 0, 0}, {0, 0, 0}};
  GstSpidarError error = {GST_SPIDAR_ERROR_FAILED, "old"};
  /* The strings can give a force of this size at the centre, except for what the solver sacrifices
   * for even tensions: less than a hundredth. The simulated hand yields by 1 N / 300 N/m, and the
   * strings at rest, 0.3 N each and at least 0.1 m long, pull the grip back from there by 0.08 N. */
  const double close_N = 0.01 + 0.08;
  COMES_TRUE((REQUIRE(gst_spidar_device_push(device, &wanted, &error)),
              gst_spidar_device_felt(device, &felt),
              fabs(felt.force_N.x - 0.5) < close_N && fabs(felt.force_N.y - 0.25) < close_N &&
                  fabs(felt.force_N.z + 0.125) < close_N && felt.torque_Nm.z > 0.005));
  REQUIRE(error.kind == GST_SPIDAR_OK && error.message[0] == '\0');
  gst_spidar_device_rest(device);
  COMES_TRUE((gst_spidar_device_felt(device, &felt), fabs(felt.force_N.x) < 0.01));
}

static void a_device_tells_what_it_does(const GstSpidarDevice* device) {
  GstSpidarPose pose = {{9, 9, 9}, {9, 9, 9, 9}};
  GstSpidarVector3 velocity_m_s = {9, 9, 9};
  GstSpidarCapabilities can;
  char text[8] = "old";
  REQUIRE(strcmp(gst_spidar_device_name(device), "sim") == 0);
  REQUIRE(gst_spidar_device_state(device) == GST_SPIDAR_RUNNING);
  REQUIRE(gst_spidar_device_pose(device, &pose));
  /* A hand holds the simulated grip, and is soft. */
  REQUIRE(fabs(pose.position_m.x) < 0.01 && fabs(pose.position_m.z) < 0.01);
  REQUIRE(fabs(pose.orientation.w - 1) < 0.01);
  REQUIRE(gst_spidar_device_velocity(device, &velocity_m_s) && fabs(velocity_m_s.z) < 0.5);
  REQUIRE(gst_spidar_device_held(device));
  REQUIRE(gst_spidar_device_buttons(device) == 0);
  REQUIRE(gst_spidar_device_vibration_fraction(device) == 1);
  REQUIRE(gst_spidar_device_last_fault(device, text, sizeof text) == 0 && text[0] == '\0');
  REQUIRE(gst_spidar_device_warning(device, text, sizeof text) == 0 && text[0] == '\0');
  gst_spidar_device_capabilities(device, &can);
  REQUIRE(can.force_x && can.force_y && can.force_z && can.torque && can.direction);
  REQUIRE(can.largest_force_N == 7.2 && can.largest_stiffness_N_m == 800 && can.rate_Hz == 1000);
  REQUIRE(can.largest_torque_Nm >= 0.1 && can.largest_torque_Nm < 1);
  REQUIRE(fabs(can.workspace_m.x - 0.059) < 1e-9 && fabs(can.workspace_m.y - 0.064) < 1e-9);
  REQUIRE(can.buttons == 0);
}

static void limits_are_those_of_the_device(GstSpidarDevice* device) {
  const GstSpidarWrench nan_wrench = {{nan(""), 0, 0}, {0, 0, 0}};
  GstSpidarError error;
  REQUIRE(gst_spidar_device_set_limits(device, 7.2, 0.1, NULL));
  REQUIRE(!gst_spidar_device_set_limits(device, 1e9, 0.1, &error));
  REQUIRE(error.kind == GST_SPIDAR_ERROR_ARGUMENT &&
          strstr(error.message, "0 to 7.2 N, which spidar-gcc can give"));
  REQUIRE(!gst_spidar_device_push(device, &nan_wrench, &error));
  REQUIRE(error.kind == GST_SPIDAR_ERROR_ARGUMENT && strstr(error.message, "six finite numbers"));
}

static void a_surface_is_touched(GstSpidarDevice* device) {
  uint8_t white[16 * 17];
  GstSpidarSurface surface = {{white, 16, 16, 17}, 0.008, 200, 0.3, 0};
  GstSpidarWrench felt = {{0, 0, 0}, {0, 0, 0}};
  GstSpidarError error;
  memset(white, 255, sizeof white);
  REQUIRE(gst_spidar_device_set_surface(device, &surface, &error));
  /* 4 mm in front of the hand: 200 N/m against its 300 N/m give 0.48 N. */
  COMES_TRUE((gst_spidar_device_felt(device, &felt), felt.force_N.z > 0.3));
  gst_spidar_device_clear_surface(device);
  COMES_TRUE((gst_spidar_device_felt(device, &felt), fabs(felt.force_N.z) < 0.05));
  surface.texture = -1;
  REQUIRE(!gst_spidar_device_set_surface(device, &surface, &error));
  REQUIRE(error.kind == GST_SPIDAR_ERROR_ARGUMENT && strstr(error.message, "texture"));
}

/* What a callback was told and is to say. */
typedef struct {
  atomic_int calls;
  atomic_bool goes_on;
  _Atomic double interval_s;
  _Atomic double w;
} Told;

static bool callback(const GstSpidarGripState* grip, GstSpidarWrench* wrench, void* user_data) {
  Told* const told = user_data;
  told->w = grip->pose.orientation.w;
  told->interval_s = grip->interval_s;
  if (wrench->force_N.x == 0) wrench->force_N.x = 1;
  ++told->calls;
  return told->goes_on;
}

static void a_callback_is_felt(GstSpidarDevice* device) {
  Told told = {0, true, 0, 0};
  GstSpidarWrench felt = {{0, 0, 0}, {0, 0, 0}};
  GstSpidarError error;
  char text[100] = "old", shorter[8];
  REQUIRE(!gst_spidar_device_set_callback(device, callback, &told, (GstSpidarEnergy)7, &error));
  REQUIRE(error.kind == GST_SPIDAR_ERROR_ARGUMENT);
  REQUIRE(gst_spidar_device_set_callback(device, callback, &told, GST_SPIDAR_ANY, &error));
  COMES_TRUE((gst_spidar_device_felt(device, &felt), felt.force_N.x > 0.9));
  REQUIRE(told.interval_s > 0 && told.interval_s < 0.1 && fabs(told.w - 1) < 0.01);
  REQUIRE(gst_spidar_device_callback_error(device, text, sizeof text) == 0 && text[0] == '\0');
  told.goes_on = false;
  COMES_TRUE(gst_spidar_device_callback_error(device, text, sizeof text) > 0);
  REQUIRE(strstr(text, "it has returned false"));
  REQUIRE(gst_spidar_device_callback_error(device, shorter, sizeof shorter) == strlen(text));
  REQUIRE(strcmp(shorter, "the cal") == 0);
  REQUIRE(gst_spidar_device_callback_error(device, NULL, 0) == strlen(text));
  {
    const int calls = told.calls;
    REQUIRE(gst_spidar_device_set_callback(device, NULL, NULL, GST_SPIDAR_PASSIVE, NULL));
    wait_ms(20);
    REQUIRE(told.calls == calls);
  }
}

/* Spots of 4 × 4 pixels that move by whole pixels. */
static const uint8_t* spots(int shift, int side) {
  static uint8_t pixels[240 * 240];
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const unsigned spot = (unsigned)((x - shift + side) / 4 * 73 + y / 4 * 151);
      pixels[y * side + x] = (uint8_t)((spot * 2654435761u) >> 24);
    }
  return pixels;
}

static void pictures_become_a_wrench(void) {
  GstSpidarError error;
  GstSpidarMotionResult found;
  GstSpidarMotion* const motion = gst_spidar_motion_new(&error);
  GstSpidarPicture picture = {NULL, 240, 240, 240};
  REQUIRE(motion && error.kind == GST_SPIDAR_OK);
  GstSpidarMotionSettings settings;
  gst_spidar_motion_settings_init(&settings);
  REQUIRE(settings.controller == GST_SPIDAR_NONLINEAR && settings.motion == GST_SPIDAR_OBJECT);
  REQUIRE(settings.max_force_N == 3 && settings.alpha_s_px == 0.0025 && settings.pointer_y == 0.5);
  settings.motion = GST_SPIDAR_MEAN;
  settings.max_force_N = 1.5;
  REQUIRE(gst_spidar_motion_configure(motion, &settings, &error));
  for (int i = 0; i < 10; ++i) {
    picture.data = spots(4 * i, 240);
    REQUIRE(gst_spidar_motion_analyze(motion, &picture, 40000000 * (int64_t)i, &found, &error));
    REQUIRE(found.has_picture_before == (i > 0));
  }
  /* 4 px in 40 ms; a mean displacement is right to 0.03 px. Equation 15 of the paper is for a picture
   * of 480 lines, which has twice as many. */
  REQUIRE(fabs(found.velocity_x_px_s - 100) < 0.03 / 0.04);
  REQUIRE(fabs(found.velocity_y_px_s) < 0.03 / 0.04);
  REQUIRE(fabs(found.growth_1_s) < 0.1 && fabs(found.roll_rad_s) < 0.1);
  REQUIRE(fabs(found.wrench.force_N.x - 2 * 1.5 / acos(-1) * atan(0.0025 * 200)) < 0.015);
  gst_spidar_motion_reset(motion);
  REQUIRE(gst_spidar_motion_analyze(motion, &picture, 400000000, &found, NULL));
  REQUIRE(!found.has_picture_before);
  settings.motion = (GstSpidarFeltMotion)9;
  REQUIRE(!gst_spidar_motion_configure(motion, &settings, &error));
  settings.motion = GST_SPIDAR_OBJECTS;
  settings.controller = (GstSpidarController)9;
  REQUIRE(!gst_spidar_motion_configure(motion, &settings, &error));
  settings.controller = GST_SPIDAR_LINEAR;
  settings.roll_gain = -1;
  REQUIRE(!gst_spidar_motion_configure(motion, &settings, &error) && strstr(error.message, "roll"));
  settings.roll_gain = 2;
  REQUIRE(gst_spidar_motion_configure(motion, &settings, &error));
  picture.stride = 239;
  REQUIRE(!gst_spidar_motion_analyze(motion, &picture, 440000000, &found, &error));
  REQUIRE(error.kind == GST_SPIDAR_ERROR_ARGUMENT && strstr(error.message, "stride 239"));
  gst_spidar_motion_free(motion);
  gst_spidar_motion_free(NULL);
}

int main(void) {
  GstSpidarDevice* device;
  names_are_listed();
  what_is_wrong_is_named();
  pictures_become_a_wrench();
  device = gst_spidar_device_open("sim", "", NULL);
  REQUIRE(device && gst_spidar_device_wait_until_running(device, INT64_MAX));
  a_device_tells_what_it_does(device);
  a_push_is_felt(device);
  limits_are_those_of_the_device(device);
  a_surface_is_touched(device);
  a_callback_is_felt(device);
  gst_spidar_device_close(device);
  gst_spidar_device_close(NULL);
  return 0;
}
