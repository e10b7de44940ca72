#include "plugin/frame_trace.h"

#include <cerrno>
#include <charconv>
#include <cstring>
#include <initializer_list>

namespace spidar {
namespace {

constexpr const char* kHeader =
    "running_time_ns,stream_time_ns,features,tracked,velocity_x_px_s,velocity_y_px_s,"
    "force_x_N,force_y_N,force_z_N,torque_x_Nm,torque_y_Nm,torque_z_Nm\n";

template <typename Number>
void append(std::string& row, Number value) {
  char text[32];
  const std::to_chars_result end = std::to_chars(text, text + sizeof text, value);
  row.append(text, end.ptr).push_back(',');
}

}  // namespace

std::string FrameTrace::open(const std::string& path) {
  close();
  file_ = std::fopen(path.c_str(), "we");
  if (!file_) return std::strerror(errno);
  if (std::fputs(kHeader, file_) < 0 || std::fflush(file_) != 0) {
    const std::string reason = std::strerror(errno);
    close();
    return reason;
  }
  return {};
}

bool FrameTrace::write(int64_t running_time_ns, int64_t stream_time_ns,
                       const FrameAnalysis& frame) {
  std::string row;
  row.reserve(256);
  append(row, running_time_ns);
  append(row, stream_time_ns);
  append(row, frame.features);
  append(row, frame.motion.tracked);
  const Eigen::Vector2d& velocity = frame.motion.velocity_px_s;
  const Eigen::Vector3d& force = frame.wrench.force_N;
  const Eigen::Vector3d& torque = frame.wrench.torque_Nm;
  for (double value : {velocity.x(), velocity.y(), force.x(), force.y(), force.z(), torque.x(),
                       torque.y(), torque.z()}) {
    append(row, value);
  }
  row.back() = '\n';
  if (std::fwrite(row.data(), 1, row.size(), file_) == row.size()) return true;
  close();
  return false;
}

bool FrameTrace::close() {
  if (!file_) return true;
  const bool written = std::fclose(file_) == 0;
  file_ = nullptr;
  return written;
}

}  // namespace spidar
