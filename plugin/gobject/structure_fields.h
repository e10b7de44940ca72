// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Fields of a record in a GstStructure.
#pragma once

#include <iterator>
#include <string>
#include <variant>

#include <gst/gst.h>

#include "core/fields.h"

namespace spidar {

/// Sets the fields of a structure, and overwrites those that it already has.
class StructureFields : public FieldSink {
 public:
  explicit StructureFields(GstStructure* structure, unsigned outputs = 0)
      : FieldSink(outputs), structure_(structure) {}

 private:
  void write(const Field& field, const FieldValue& value) override {
    if (const auto* const parts = std::get_if<Parts>(&value)) {
      for (const auto& [part, scalar] : *parts) {
        set((std::string(field.name) + '-' + part).c_str(), scalar);
      }
    } else if (const auto* const scalar = std::get_if<Scalar>(&value)) {
      set(field.name, *scalar);
    } else {
      GValue array = G_VALUE_INIT, item = G_VALUE_INIT;
      gst_value_array_init(&array, 0);
      g_value_init(&item, G_TYPE_DOUBLE);
      for (const double number : std::get<Eigen::MatrixXd>(value).reshaped()) {
        g_value_set_double(&item, number);
        gst_value_array_append_value(&array, &item);
      }
      gst_structure_take_value(structure_, field.name, &array);
    }
  }
  void set(const char* name, const Scalar& scalar) {
    constexpr GType kTypes[] = {G_TYPE_BOOLEAN, G_TYPE_INT,    G_TYPE_UINT,  G_TYPE_UINT64,
                                G_TYPE_UINT64,  G_TYPE_DOUBLE, G_TYPE_STRING};
    static_assert(std::size(kTypes) == std::variant_size_v<Scalar>);
    const auto put = [&](auto value) {
      gst_structure_set(structure_, name, kTypes[scalar.index()], value, nullptr);
    };
    std::visit(put, scalar);
  }

  GstStructure* const structure_;
};

}  // namespace spidar
