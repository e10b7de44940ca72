// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/sample_file.h"

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <unistd.h>

namespace spidar {
namespace {

constexpr size_t kAtOnce = 4096;  // samples

}  // namespace

void SampleFile::add(const TrackSample& sample) {
  waiting_.push_back(sample);
  ++count_;
  if (waiting_.size() == kAtOnce) flush();
}

void SampleFile::flush() {
  part_.write(
      {reinterpret_cast<const char*>(waiting_.data()), waiting_.size() * sizeof(TrackSample)});
  waiting_.clear();
}

SampleSource SampleFile::samples(double gain) const {
  return {count_, [this, gain](const SampleSource::Take& take) {
            std::vector<TrackSample> samples(kAtOnce);
            for (size_t at = 0; at < count_;) {
              const ssize_t got =
                  pread(part_.descriptor(), samples.data(), samples.size() * sizeof(TrackSample),
                        static_cast<off_t>(at * sizeof(TrackSample)));
              if (got < 0 && errno == EINTR) continue;
              const size_t whole = got > 0 ? static_cast<size_t>(got) / sizeof(TrackSample) : 0;
              if (whole == 0) {
                throw std::runtime_error(
                    part_.path() + ": cannot be read: " + std::strerror(got < 0 ? errno : EIO));
              }
              for (size_t i = 0; i < whole; ++i) {
                for (float& value : samples[i]) value = static_cast<float>(gain * value);
                take(samples[i]);
              }
              at += whole;
            }
          }};
}

}  // namespace spidar
