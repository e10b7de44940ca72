// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The udev rule gives access to the devices of device=ff, and to no other input devices.
#include <fcntl.h>
#include <fnmatch.h>
#include <regex>
#include <unistd.h>

#include "tests/emulated_bus/bus_state.h"
#include "tests/support/test.h"

namespace spidar::test::ff_udev_rule_test {
namespace {

struct Condition {
  std::string key, operation, value;
};

/// The rule for input devices, as udev splits it; comments are no rules.
std::vector<Condition> input_rule() {
  std::ifstream file(UDEV_RULES);
  const std::regex part(R"re(([A-Z]+(?:\{[^}]*\})?)(==|!=|\+=|=)"([^"]*)")re");
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("SUBSYSTEM==\"input\"", 0) != 0) continue;
    std::vector<Condition> rule;
    for (std::sregex_iterator at(line.begin(), line.end(), part), end; at != end; ++at)
      rule.push_back({(*at)[1], (*at)[2], (*at)[3]});
    return rule;
  }
  return {};
}

/// Attribute of the input device in the emulated sysfs.
std::string attribute(size_t number, const std::string& name) {
  const std::string path = "/sys/class/input/event" + std::to_string(number) + "/device/" + name;
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  std::string text(256, '\0');
  const ssize_t length = file < 0 ? 0 : ::read(file, text.data(), text.size());
  if (file >= 0) ::close(file);
  text.resize(static_cast<size_t>(length > 0 ? length : 0));
  return text.substr(0, text.find('\n'));
}

/// Whether udev would give the user at the seat access to the device: patterns are those of a
/// shell, and an attribute that does not exist matches nothing.
bool gives_access(const std::vector<Condition>& rule, size_t number) {
  bool access = false;
  for (const auto& [key, operation, value] : rule) {
    std::string actual;
    if (key == "SUBSYSTEM") actual = "input";
    if (key == "KERNEL") actual = "event" + std::to_string(number);
    if (key.rfind("ATTRS{", 0) == 0) {
      actual = attribute(number, key.substr(6, key.size() - 7));
      if (actual.empty()) return false;
    }
    const bool equal = fnmatch(value.c_str(), actual.c_str(), 0) == 0;
    if (operation == "==" && !equal) return false;
    if (operation == "!=" && equal) return false;
    access |= key == "TAG" && operation == "+=" && value == "uaccess";
  }
  return access;
}

TEST(ForceFeedbackUdevRule, GivesAccessToDevicesWithForceFeedbackOnly) {
  const std::vector<Condition> rule = input_rule();
  ASSERT_FALSE(rule.empty());
  clear_bus();
  plug_evdev(0, EvdevKind::kStick);
  plug_evdev(1, EvdevKind::kWheel);
  plug_evdev(2, EvdevKind::kPad);
  plug_evdev(3, EvdevKind::kKeyboard);
  EXPECT_TRUE(gives_access(rule, 0));
  EXPECT_TRUE(gives_access(rule, 1));
  EXPECT_TRUE(gives_access(rule, 2));
  EXPECT_FALSE(gives_access(rule, 3));
  clear_bus();
  EXPECT_FALSE(gives_access(rule, 0));
}

/// 73-seat-late.rules of systemd acts on the tag.
TEST(ForceFeedbackUdevRule, IsReadBeforeTheRuleThatActsOnItsTag) {
  EXPECT_LT(std::filesystem::path(UDEV_RULES).filename().string(), "73-seat-late.rules");
}

}  // namespace
}  // namespace spidar::test::ff_udev_rule_test
