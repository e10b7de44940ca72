// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/support/random_source.h"

namespace spidar::test {
namespace {

template <typename Spec, typename Number>
Number number(const Spec& spec, RandomSource& random) {
  switch (random.below(4)) {
    case 0:
      return spec.minimum;
    case 1:
      return spec.maximum;
    default:
      const double low = static_cast<double>(spec.minimum),
                   high = static_cast<double>(spec.maximum);
      return static_cast<Number>(low + random.fraction() * (high - low));
  }
}

bool is_settable(const GParamSpec* spec) {
  return G_IS_PARAM_SPEC_BOOLEAN(spec) || G_IS_PARAM_SPEC_ENUM(spec) ||
         G_IS_PARAM_SPEC_DOUBLE(spec) || G_IS_PARAM_SPEC_UINT(spec) || G_IS_PARAM_SPEC_INT64(spec);
}

}  // namespace

void set_random_value(GParamSpec* spec, RandomSource& random, GValue* value) {
  g_value_init(value, G_PARAM_SPEC_VALUE_TYPE(spec));
  g_param_value_set_default(spec, value);
  if (random.chance(0.8)) return;
  if (G_IS_PARAM_SPEC_BOOLEAN(spec)) {
    g_value_set_boolean(value, random.chance(0.5));
  } else if (G_IS_PARAM_SPEC_ENUM(spec)) {
    const GEnumClass* values = G_PARAM_SPEC_ENUM(spec)->enum_class;
    g_value_set_enum(value, values->values[random.below(values->n_values)].value);
  } else if (G_IS_PARAM_SPEC_DOUBLE(spec)) {
    const auto* range = G_PARAM_SPEC_DOUBLE(spec);
    g_value_set_double(value, number<GParamSpecDouble, double>(*range, random));
  } else if (G_IS_PARAM_SPEC_UINT(spec)) {
    const auto* range = G_PARAM_SPEC_UINT(spec);
    g_value_set_uint(value, number<GParamSpecUInt, guint>(*range, random));
  } else if (G_IS_PARAM_SPEC_INT64(spec)) {
    const auto* range = G_PARAM_SPEC_INT64(spec);
    g_value_set_int64(value, number<GParamSpecInt64, gint64>(*range, random));
  }
}

std::vector<std::string> random_properties(GObject* object) {
  guint count = 0;
  GParamSpec** specs = g_object_class_list_properties(G_OBJECT_GET_CLASS(object), &count);
  std::vector<std::string> names;
  for (guint i = 0; i < count; ++i) {
    const bool own = specs[i]->owner_type == G_OBJECT_TYPE(object);
    const bool writable = (specs[i]->flags & G_PARAM_WRITABLE) != 0;
    if (own && writable && is_settable(specs[i])) names.emplace_back(specs[i]->name);
  }
  g_free(specs);
  return names;
}

}  // namespace spidar::test
