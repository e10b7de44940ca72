// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/**
 * SECTION:provider-spidardeviceprovider
 * @title: spidardeviceprovider
 * @short_description: SPIDAR boards that are plugged in, and the simulated one
 *
 * Lists what #spidarmotion:device can be, and tells when boards come and go. No board is opened and
 * nothing is sent to one before an element is made of it and leaves the NULL state.
 *
 * The devices are of the class `Sink/Haptic/SPIDAR`. Their properties: `device` and `profile`, as
 * of #spidarmotion; `board`, the board's name; `evidence`, how far its driver has been tried;
 * `bus-path`, `serial`, `usb-id`; `accessible` (boolean), this process may open it; `note`. What is
 * empty is left out.
 *
 * ## Example launch line
 * |[
 * gst-device-monitor-1.0 -f Haptic/SPIDAR
 * ]|
 *
 * Since: 0.1
 */
#include "plugin/provider/device_provider.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <functional>
#include <iterator>
#include <mutex>
#include <string>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include "plugin/gobject/ref.h"
#include "spidar/realtime/thread_setup.h"
#include "spidar/session/board_list.h"

namespace spidar {

/// Lists the boards again and again on a thread of its own. libusb's hotplug events would not be
/// enough: they tell nothing of serial lines, and come before udev has given the permission.
class BoardWatch {
 public:
  static constexpr std::chrono::milliseconds kInterval{500};

  /// `changed` is called on the thread, with what is gone and what is there in addition to `known`.
  using Changed =
      std::function<void(const std::vector<BoardInfo>& gone, const std::vector<BoardInfo>& come)>;
  BoardWatch(std::vector<BoardInfo> known, Changed changed);
  ~BoardWatch();
  BoardWatch(const BoardWatch&) = delete;
  BoardWatch& operator=(const BoardWatch&) = delete;

 private:
  void run();

  std::vector<BoardInfo> known_;
  const Changed changed_;
  std::mutex mutex_;
  std::condition_variable ended_;
  bool end_ = false;
  std::thread thread_;
};

namespace {

/// Boards count as different when the serial number or the permission to open them differs.
bool same(const BoardInfo& a, const BoardInfo& b) {
  return std::tie(a.device, a.usb_id, a.serial, a.accessible) ==
         std::tie(b.device, b.usb_id, b.serial, b.accessible);
}

/// The elements of `boards` that are not in `others`.
std::vector<BoardInfo> without(const std::vector<BoardInfo>& boards,
                               const std::vector<BoardInfo>& others) {
  std::vector<BoardInfo> left;
  std::copy_if(boards.begin(), boards.end(), std::back_inserter(left), [&](const BoardInfo& board) {
    return std::none_of(others.begin(), others.end(),
                        [&](const BoardInfo& other) { return same(board, other); });
  });
  return left;
}

/// What spidarmotion can be given: the boards that there are, and one simulated device. None is
/// opened.
std::vector<BoardInfo> playable_boards() {
  std::vector<BoardInfo> boards = list_boards();
  // The device behind the packets of an emulated board is the same simulated one.
  boards.erase(std::remove_if(
                   boards.begin(), boards.end(),
                   [](const BoardInfo& board) { return board.device.compare(0, 4, "sim:") == 0; }),
               boards.end());
  return boards;
}

}  // namespace

BoardWatch::BoardWatch(std::vector<BoardInfo> known, Changed changed)
    : known_(std::move(known)), changed_(std::move(changed)) {
  thread_ = start_thread("spidar-boards", [this] { run(); });
}

BoardWatch::~BoardWatch() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    end_ = true;
  }
  ended_.notify_all();
  thread_.join();
}

void BoardWatch::run() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!ended_.wait_for(lock, kInterval, [this] { return end_; })) {
    lock.unlock();
    std::vector<BoardInfo> now = playable_boards();
    const std::vector<BoardInfo> gone = without(known_, now), come = without(now, known_);
    known_ = std::move(now);
    if (!gone.empty() || !come.empty()) changed_(gone, come);
    lock.lock();
  }
}

}  // namespace spidar

using spidar::BoardInfo;
using spidar::BoardWatch;
using spidar::Ref;

static constexpr const char* kElement = "spidarmotion";
static constexpr const char* kDeviceClass = "Sink/Haptic/SPIDAR";

// --- device ------------------------------------------------------------------------------------

struct _GstSpidarDevice {
  GstDevice parent;

  BoardInfo* board;
};

G_DEFINE_FINAL_TYPE(GstSpidarDevice, gst_spidar_device, GST_TYPE_DEVICE)

static GstStructure* properties_of(const BoardInfo& board) {
  GstStructure* properties = gst_structure_new(
      "spidar", "device", G_TYPE_STRING, board.device.c_str(), "board", G_TYPE_STRING,
      board.name.c_str(), "evidence", G_TYPE_STRING, spidar::to_string(board.trial), "accessible",
      G_TYPE_BOOLEAN, board.accessible, nullptr);
  const std::pair<const char*, const std::string&> may_be_empty[] = {
      {"profile", board.profile}, {"bus-path", board.path}, {"serial", board.serial},
      {"usb-id", board.usb_id},   {"note", board.note},
  };
  for (const auto& [name, value] : may_be_empty)
    if (!value.empty()) gst_structure_set(properties, name, G_TYPE_STRING, value.c_str(), nullptr);
  return properties;
}

static GstDevice* device_of(const BoardInfo& board) {
  const std::string name = board.path.empty() ? board.name : board.name + " (" + board.device + ")";
  GstStructure* properties = properties_of(board);
  const Ref<GstCaps> caps(gst_caps_new_empty_simple("video/x-raw"));
  auto* device = static_cast<GstSpidarDevice*>(
      g_object_new(GST_TYPE_SPIDAR_DEVICE, "display-name", name.c_str(), "device-class",
                   kDeviceClass, "caps", caps.get(), "properties", properties, nullptr));
  gst_structure_free(properties);
  device->board = new BoardInfo(board);
  return GST_DEVICE(device);
}

static void give(const BoardInfo& board, GstElement* element) {
  g_object_set(element, "device", board.device.c_str(), nullptr);
  if (!board.profile.empty()) g_object_set(element, "profile", board.profile.c_str(), nullptr);
}

static GstElement* gst_spidar_device_create_element(GstDevice* device, const gchar* name) {
  GstElement* element = gst_element_factory_make(kElement, name);
  if (element) give(*GST_SPIDAR_DEVICE(device)->board, element);
  return element;
}

static gboolean gst_spidar_device_reconfigure_element(GstDevice* device, GstElement* element) {
  GstElementFactory* const factory = gst_element_get_factory(element);
  if (!factory || std::strcmp(GST_OBJECT_NAME(factory), kElement) != 0) return FALSE;
  // An element keeps the device that it has opened.
  if (GST_STATE(element) != GST_STATE_NULL) return FALSE;
  give(*GST_SPIDAR_DEVICE(device)->board, element);
  return TRUE;
}

static void gst_spidar_device_finalize(GObject* object) {
  delete GST_SPIDAR_DEVICE(object)->board;
  G_OBJECT_CLASS(gst_spidar_device_parent_class)->finalize(object);
}

static void gst_spidar_device_init(GstSpidarDevice*) {}

static void gst_spidar_device_class_init(GstSpidarDeviceClass* klass) {
  G_OBJECT_CLASS(klass)->finalize = gst_spidar_device_finalize;
  GST_DEVICE_CLASS(klass)->create_element = gst_spidar_device_create_element;
  GST_DEVICE_CLASS(klass)->reconfigure_element = gst_spidar_device_reconfigure_element;
}

// --- provider ----------------------------------------------------------------------------------

struct _GstSpidarDeviceProvider {
  GstDeviceProvider parent;

  BoardWatch* watch;  // null unless the provider is started
};

G_DEFINE_FINAL_TYPE(GstSpidarDeviceProvider, gst_spidar_device_provider, GST_TYPE_DEVICE_PROVIDER)
GST_DEVICE_PROVIDER_REGISTER_DEFINE(spidardeviceprovider, "spidardeviceprovider", GST_RANK_MARGINAL,
                                    GST_TYPE_SPIDAR_DEVICE_PROVIDER)

static GList* gst_spidar_device_provider_probe(GstDeviceProvider*) {
  GList* devices = nullptr;
  for (const BoardInfo& board : spidar::playable_boards())
    devices = g_list_append(devices, device_of(board));
  return devices;
}

/// The provider's device for that board, or none.
static Ref<GstDevice> find_device(GstDeviceProvider* provider, const BoardInfo& board) {
  Ref<GstDevice> found;
  GST_OBJECT_LOCK(provider);
  for (GList* item = provider->devices; item && !found; item = item->next)
    if (GST_SPIDAR_DEVICE(item->data)->board->device == board.device)
      found = spidar::new_ref(GST_DEVICE(item->data));
  GST_OBJECT_UNLOCK(provider);
  return found;
}

static void add_and_remove(GstDeviceProvider* provider, const std::vector<BoardInfo>& gone,
                           const std::vector<BoardInfo>& come) {
  for (const BoardInfo& board : gone) {
    const Ref<GstDevice> device = find_device(provider, board);
    if (device) gst_device_provider_device_remove(provider, device.get());
  }
  for (const BoardInfo& board : come) gst_device_provider_device_add(provider, device_of(board));
}

static gboolean gst_spidar_device_provider_start(GstDeviceProvider* provider) {
  std::vector<BoardInfo> boards = spidar::playable_boards();
  add_and_remove(provider, {}, boards);
  GST_SPIDAR_DEVICE_PROVIDER(provider)->watch = new BoardWatch(
      std::move(boards),
      [provider](const auto& gone, const auto& come) { add_and_remove(provider, gone, come); });
  return TRUE;
}

static void gst_spidar_device_provider_stop(GstDeviceProvider* provider) {
  GstSpidarDeviceProvider* self = GST_SPIDAR_DEVICE_PROVIDER(provider);
  delete self->watch;
  self->watch = nullptr;
}

static void gst_spidar_device_provider_dispose(GObject* object) {
  gst_spidar_device_provider_stop(GST_DEVICE_PROVIDER(object));
  G_OBJECT_CLASS(gst_spidar_device_provider_parent_class)->dispose(object);
}

static void gst_spidar_device_provider_init(GstSpidarDeviceProvider*) {}

static void gst_spidar_device_provider_class_init(GstSpidarDeviceProviderClass* klass) {
  GstDeviceProviderClass* provider_class = GST_DEVICE_PROVIDER_CLASS(klass);
  G_OBJECT_CLASS(klass)->dispose = gst_spidar_device_provider_dispose;
  provider_class->probe = gst_spidar_device_provider_probe;
  provider_class->start = gst_spidar_device_provider_start;
  provider_class->stop = gst_spidar_device_provider_stop;
  gst_device_provider_class_set_static_metadata(
      provider_class, "SPIDAR device provider", kDeviceClass,
      "Lists SPIDAR haptic devices and the simulated one", "The gst-spidar authors");
}
