// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Fuzz target of what the desktop's portal and other programs' windows say to spidar-feel --screen;
// tests/README.md says how to run it under libFuzzer. The first byte chooses a type of the portal's
// values, or the size of a property's items; the rest is the value. What is read must be of the
// type that it is taken for.
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "numbers.h"
#include "plugin/feel/screen/portal_answers.h"
#include "plugin/feel/screen/x11_property.h"

using namespace spidar;
using namespace spidar::screen;

namespace {

void read_results(GVariant* results) {
  const std::string session = session_in(results);
  require(session.empty() || g_variant_is_object_path(session.c_str()), "fuzz_screen: no path");
  const Shared shared(results);
  require(g_utf8_validate(shared.token.c_str(), -1, nullptr), "fuzz_screen: no text");
}

void read_portal(const char* type, const uint8_t* data, size_t size) {
  const auto bytes =
      std::unique_ptr<GBytes, decltype(&g_bytes_unref)>(g_bytes_new(data, size), g_bytes_unref);
  const Ref<GVariant> raw(
      g_variant_ref_sink(g_variant_new_from_bytes(G_VARIANT_TYPE(type), bytes.get(), FALSE)));
  // As the bus gives it.
  const Ref<GVariant> value(g_variant_get_normal_form(raw.get()));
  const PortalAnswer answer(value.get());
  if (answer.results) read_results(answer.results.get());
  if (g_variant_is_of_type(value.get(), G_VARIANT_TYPE_VARDICT)) read_results(value.get());
  gint32 index = 0;
  require(read_variant(value.get(), "(h)", &index) == (type == std::string("(h)")),
          "fuzz_screen: another type");
}

/// Xlib gives 32 bits as a long, and a zero behind the last item.
void read_property(int bits, const uint8_t* data, size_t size) {
  constexpr unsigned long kType = 31;
  const size_t item = bits == 32 ? sizeof(long) : static_cast<size_t>(bits) / 8;
  std::vector<unsigned char> bytes(data, data + size / item * item);
  bytes.push_back(0);
  bytes.shrink_to_fit();
  const Property property{size % 7 == 0 ? kType + 1 : kType, bits, size / item, bytes.data()};
  const size_t count = property.type == kType ? property.count : 0;
  const auto windows = items_of<std::vector<unsigned long>>(property, kType);
  require(windows.size() == (bits == 32 ? count : 0), "fuzz_screen: windows of other items");
  const auto text = items_of<std::string>(property, kType);
  require(text.size() == (bits == 8 ? count : 0), "fuzz_screen: a text of other items");
  require(g_utf8_validate(text_of(text).c_str(), -1, nullptr), "fuzz_screen: a title that is none");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  constexpr std::array<const char*, 6> kTypes{"(ua{sv})", "a{sv}", "(us)", "(h)", "(sss)", "v"};
  constexpr std::array<int, 3> kBits{8, 16, 32};
  if (size == 0) return 0;
  const size_t choice = data[0] % (kTypes.size() + kBits.size());
  if (choice < kTypes.size()) {
    read_portal(kTypes[choice], data + 1, size - 1);
  } else {
    read_property(kBits[choice - kTypes.size()], data + 1, size - 1);
  }
  return 0;
}
