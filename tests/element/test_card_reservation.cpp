// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A sound card is asked for on a bus of its own, where another one has it, or nobody.
#include <gio/gio.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "plugin/device/card_reservation.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test.h"

namespace spidar::test::card_reservation_test {
namespace {

constexpr const char* kName = "org.freedesktop.ReserveDevice1.Audio3";
constexpr const char* kPath = "/org/freedesktop/ReserveDevice1/Audio3";
constexpr const char* kInterface = "org.freedesktop.ReserveDevice1";

/// Another program on the bus.
class Program {
 public:
  explicit Program(GTestDBus* bus)
      : connection_(g_dbus_connection_new_for_address_sync(
            g_test_dbus_get_bus_address(bus),
            static_cast<GDBusConnectionFlags>(G_DBUS_CONNECTION_FLAGS_AUTHENTICATION_CLIENT |
                                              G_DBUS_CONNECTION_FLAGS_MESSAGE_BUS_CONNECTION),
            nullptr, nullptr, nullptr)) {
    g_dbus_connection_add_filter(connection_.get(), answer, this, nullptr);
  }
  ~Program() { g_dbus_connection_close_sync(connection_.get(), nullptr, nullptr); }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  Ref<GVariant> call(const char* to, const char* path, const char* interface, const char* method,
                     GVariant* arguments) const {
    return Ref<GVariant>(g_dbus_connection_call_sync(connection_.get(), to, path, interface, method,
                                                     arguments, nullptr, G_DBUS_CALL_FLAGS_NONE,
                                                     1000, nullptr, nullptr));
  }
  /// As a sound server: it lets others replace it, and does not wait.
  guint32 own() const {
    const Ref<GVariant> result =
        call("org.freedesktop.DBus", "/org/freedesktop/DBus", "org.freedesktop.DBus", "RequestName",
             g_variant_new("(su)", kName, 1u | 4u));
    guint32 code = 0;
    g_variant_get(result.get(), "(u)", &code);
    return code;
  }
  bool owns() const {
    const Ref<GVariant> result =
        call("org.freedesktop.DBus", "/org/freedesktop/DBus", "org.freedesktop.DBus",
             "GetNameOwner", g_variant_new("(s)", kName));
    const char* owner = "";
    if (result) g_variant_get(result.get(), "(&s)", &owner);
    return g_strcmp0(owner, g_dbus_connection_get_unique_name(connection_.get())) == 0;
  }

  enum class Manner { kGives, kKeeps, kSilent };
  std::atomic<Manner> manner{Manner::kGives};
  std::atomic<int> asked_with{0};  ///< the priority

 private:
  static GDBusMessage* answer(GDBusConnection* bus, GDBusMessage* message, gboolean incoming,
                              gpointer self) {
    auto& program = *static_cast<Program*>(self);
    if (!incoming || g_strcmp0(g_dbus_message_get_member(message), "RequestRelease") != 0)
      return message;
    gint32 priority = 0;
    g_variant_get(g_dbus_message_get_body(message), "(i)", &priority);
    program.asked_with = priority;
    if (program.manner != Manner::kSilent) {
      GDBusMessage* const reply = g_dbus_message_new_method_reply(message);
      g_dbus_message_set_body(reply, g_variant_new("(b)", program.manner == Manner::kGives));
      g_dbus_connection_send_message(bus, reply, G_DBUS_SEND_MESSAGE_FLAGS_NONE, nullptr, nullptr);
      g_object_unref(reply);
    }
    g_object_unref(message);
    return nullptr;
  }

  const Ref<GDBusConnection> connection_;
};

class CardReservations : public testing::Test {
 protected:
  CardReservations() {
    g_autofree gchar* daemon = g_find_program_in_path("dbus-daemon");
    if (!daemon) return;
    bus_.reset(g_test_dbus_new(G_TEST_DBUS_NONE));
    g_test_dbus_up(bus_.get());
    other_ = std::make_unique<Program>(bus_.get());
  }
  ~CardReservations() override {
    other_.reset();
    if (bus_) g_test_dbus_down(bus_.get());
  }
  void SetUp() override {
    if (!bus_) GTEST_SKIP() << "install dbus-daemon";
  }

  Ref<GTestDBus> bus_;
  std::unique_ptr<Program> other_;
  std::string refused_;
};

TEST_F(CardReservations, ACardThatNobodyHasIsTaken) {
  const auto taken = CardReservation::reserve(3, refused_);
  ASSERT_TRUE(taken) << refused_;
  EXPECT_EQ(refused_, "");
  EXPECT_EQ(other_->own(), 3u) << "it exists";
}

TEST_F(CardReservations, ASoundServerIsAskedAndGetsItBack) {
  ASSERT_EQ(other_->own(), 1u);
  {
    const auto taken = CardReservation::reserve(3, refused_);
    ASSERT_TRUE(taken) << refused_;
    EXPECT_EQ(other_->asked_with, G_MAXINT32);
    EXPECT_FALSE(other_->owns());
  }
  EXPECT_EQ(other_->own(), 1u);
}

TEST_F(CardReservations, OneThatKeepsItIsSaid) {
  ASSERT_EQ(other_->own(), 1u);
  other_->manner = Program::Manner::kKeeps;
  EXPECT_FALSE(CardReservation::reserve(3, refused_));
  EXPECT_EQ(refused_, "its owner keeps it");
  EXPECT_TRUE(other_->owns());
}

TEST_F(CardReservations, OneThatDoesNotAnswerIsNotWaitedForForEver) {
  ASSERT_EQ(other_->own(), 1u);
  other_->manner = Program::Manner::kSilent;
  EXPECT_FALSE(CardReservation::reserve(3, refused_));
  EXPECT_NE(refused_, "");
  EXPECT_TRUE(other_->owns());
}

/// As a second player, or a sound server that starts later, asks.
TEST_F(CardReservations, WhoAsksForItIsAnswered) {
  const auto taken = CardReservation::reserve(3, refused_);
  ASSERT_TRUE(taken);
  const Ref<GVariant> released =
      other_->call(kName, kPath, kInterface, "RequestRelease", g_variant_new("(i)", 5));
  ASSERT_TRUE(released);
  gboolean given = TRUE;
  g_variant_get(released.get(), "(b)", &given);
  EXPECT_FALSE(given);
  const Ref<GVariant> got = other_->call(kName, kPath, "org.freedesktop.DBus.Properties", "Get",
                                         g_variant_new("(ss)", kInterface, "Priority"));
  ASSERT_TRUE(got);
  Ref<GVariant> value(g_variant_get_child_value(got.get(), 0));
  value.reset(g_variant_get_variant(value.get()));
  EXPECT_EQ(g_variant_get_int32(value.get()), G_MAXINT32);
  EXPECT_FALSE(other_->call(kName, kPath, kInterface, "Nonsense", nullptr));
}

/// Why a card is not taken with the bus at another address.
std::string why_refused(const std::string& address) {
  const std::string before =
      g_getenv("DBUS_SESSION_BUS_ADDRESS") ? g_getenv("DBUS_SESSION_BUS_ADDRESS") : "";
  g_setenv("DBUS_SESSION_BUS_ADDRESS", address.c_str(), TRUE);
  std::string refused;
  EXPECT_FALSE(CardReservation::reserve(3, refused));
  if (before.empty())
    g_unsetenv("DBUS_SESSION_BUS_ADDRESS");
  else
    g_setenv("DBUS_SESSION_BUS_ADDRESS", before.c_str(), TRUE);
  return refused;
}

TEST(CardReservation, WithoutABusThereIsNobodyToAsk) {
  EXPECT_NE(why_refused("unix:path=/nowhere"), "");
}

/// The kernel connects whoever calls before it is accepted; nobody reads what is then said.
TEST(CardReservation, ABusThatSaysNothingIsNotWaitedForForEver) {
  const TemporaryFolder folder;
  const std::string path = (folder.path / "bus").string();
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  ASSERT_LT(path.size(), sizeof address.sun_path);
  std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
  const int silent = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  ASSERT_EQ(bind(silent, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  ASSERT_EQ(listen(silent, 8), 0);
  EXPECT_EQ(why_refused("unix:path=" + path), "the session bus does not answer");
  close(silent);
}

GDBusMessage* swallow(GDBusConnection*, GDBusMessage* message, gboolean incoming, gpointer) {
  if (!incoming) return message;
  g_object_unref(message);
  return nullptr;
}

gboolean keep_silent(GDBusServer*, GDBusConnection* connection, gpointer) {
  g_dbus_connection_add_filter(static_cast<GDBusConnection*>(g_object_ref(connection)), swallow,
                               nullptr, nullptr);
  return TRUE;
}

TEST(CardReservation, ABusThatOnlyConnectsIsNotWaitedForForEver) {
  const TemporaryFolder folder;
  g_autofree gchar* guid = g_dbus_generate_guid();
  const std::string path = "unix:path=" + (folder.path / "bus").string();
  const Ref<GDBusServer> server(g_dbus_server_new_sync(
      path.c_str(), G_DBUS_SERVER_FLAGS_RUN_IN_THREAD, guid, nullptr, nullptr, nullptr));
  ASSERT_TRUE(server);
  g_signal_connect(server.get(), "new-connection", G_CALLBACK(keep_silent), nullptr);
  g_dbus_server_start(server.get());
  EXPECT_EQ(why_refused(path), "the session bus does not answer");
  g_dbus_server_stop(server.get());
}

}  // namespace
}  // namespace spidar::test::card_reservation_test
