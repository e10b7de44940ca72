// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <algorithm>
#include <stdexcept>

#include "spidar/calibration/calibration.h"
#include "spidar/profiles/toml_field.h"

namespace spidar {
namespace {

void replace_provenance(const std::string& field, const std::string& how, const std::string& note,
                        std::vector<Provenance>& provenance) {
  const auto is_old = [&](const Provenance& row) {
    return row.field == field && row.evidence == Evidence::kMeasured;
  };
  provenance.erase(std::remove_if(provenance.begin(), provenance.end(), is_old), provenance.end());
  provenance.push_back({field, how, Evidence::kMeasured, note});
}

}  // namespace

Profile calibrated_profile(const Profile& profile, const CalibrationResult& result,
                           const std::string& how) {
  if (result.status != CalibrationStatus::kSolved)
    throw std::invalid_argument("calibration: a result that is not solved makes no profile");
  Profile calibrated = profile;
  calibrated.geometry.exit_m = result.exit_m;
  const auto count = static_cast<size_t>(profile.geometry.count);
  CalibrationRecord record;
  record.samples = result.samples;
  record.residual_m = result.residual_m;
  for (size_t i = 0; i < count; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    calibrated.drives[i].home_offset_m = result.home_offset_m[k];
    calibrated.drives[i].metres_per_count *= result.scale;
    record.home_offset_sd_m.push_back(result.home_offset_sd_m[k]);
  }
  const std::string note =
      shown(result.samples) + " samples, residual " + shown(1e6 * result.residual_m) + " um";
  replace_provenance("home_offset_m", how, note, calibrated.provenance);
  if (result.estimated.free_scale) {
    record.scale_sd = result.scale_sd;
    replace_provenance("metres_per_count", how, note, calibrated.provenance);
  }
  if (result.estimated.free_exits) {
    for (int i = 0; i < profile.geometry.count; ++i)
      record.exit_sd_m.push_back(result.exit_sd_m.col(i));
    replace_provenance("geometry", how, "exits; " + note, calibrated.provenance);
  }
  calibrated.calibration = record;
  return calibrated;
}

}  // namespace spidar
