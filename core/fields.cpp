// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/fields.h"

#include <string_view>
#include <type_traits>

#include "core/number_text.h"

namespace spidar {

std::string Field::column(const char* part) const {
  std::string text = name;
  for (const char* const more : {part, unit}) {
    if (*more != '\0') text += '_';
    for (const char letter : std::string_view(more)) {
      if (letter != ' ') text += letter;
    }
  }
  for (char& letter : text) {
    if (letter == '-' || letter == '/') letter = '_';
  }
  return text;
}

void CsvLine::write(const Field& field, const FieldValue& value) {
  if (const auto* const parts = std::get_if<Parts>(&value)) {
    for (const auto& [part, scalar] : *parts) add(field, part, scalar);
  } else {
    add(field, "", std::get<Scalar>(value));
  }
}

void CsvLine::add(const Field& field, const char* part, const Scalar& scalar) {
  if (line_.size() > begin_) line_ += ',';
  if (of_ == Of::kNames) {
    line_ += field.column(part);
    return;
  }
  std::visit(
      [this](auto value) {
        if constexpr (std::is_same_v<decltype(value), bool>) {
          line_ += value ? '1' : '0';
        } else if constexpr (std::is_arithmetic_v<decltype(value)>) {
          line_ += NumberText(value);
        } else {
          line_ += value;
        }
      },
      scalar);
}

}  // namespace spidar
