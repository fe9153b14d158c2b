// SPDX-License-Identifier: BSD-3-Clause
#include "import/rosbag/ros_messages.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace waymark {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::uint32_t kMaxSide_px = 16384;

/// Reads the fields of a message in order. ROS 1 packs them; CDR aligns each number to its size
/// and terminates strings with a zero.
class RosCursor {
 public:
  explicit RosCursor(const RosRecord& record) : cursor_{record.data}, encoding_{record.encoding} {
    if (encoding_ != RosEncoding::kCdr) return;
    cursor_.number<std::uint8_t>();
    constexpr std::uint8_t kLittleEndian = 1;
    is_known_ = cursor_.number<std::uint8_t>() == kLittleEndian;
    cursor_.number<std::uint16_t>();  // options
  }

  bool good() const { return is_known_ && cursor_.good(); }

  template <class Number>
  Number number() {
    align(sizeof(Number));
    return cursor_.number<Number>();
  }

  std::string text() {
    const ByteView bytes = block();
    const bool ends_in_zero = encoding_ == RosEncoding::kCdr && !bytes.empty();
    return ros_name(
        {reinterpret_cast<const char*>(bytes.data()), bytes.size() - (ends_in_zero ? 1U : 0U)});
  }

  ByteView block() { return cursor_.take(number<std::uint32_t>()); }

  template <class Number>
  std::vector<Number> list() {
    const auto count = number<std::uint32_t>();
    if (count > 0) align(sizeof(Number));
    const ByteView raw = cursor_.take(std::uint64_t{count} * sizeof(Number));
    std::vector<Number> values(raw.size() / sizeof(Number));
    if (!values.empty()) std::memcpy(values.data(), raw.data(), raw.size());
    return values;
  }

  template <std::size_t kCount>
  std::array<double, kCount> doubles() {
    std::array<double, kCount> values{};
    for (double& value : values)
      value = number<double>();
    return values;
  }

  RosHeader header() {
    if (encoding_ == RosEncoding::kRos1) number<std::uint32_t>();  // sequence
    const std::int64_t sec = number<std::uint32_t>();
    const std::int64_t nsec = number<std::uint32_t>();
    const auto stamp = time_from_ns(sec * 1'000'000'000 + nsec);
    if (!stamp) is_known_ = false;
    return {stamp.value_or(Timestamp{}), text()};
  }

 private:
  void align(std::size_t size) {
    if (encoding_ != RosEncoding::kCdr) return;
    constexpr std::size_t kEncapsulationBytes = 4;
    const std::size_t offset = cursor_.offset() - kEncapsulationBytes;
    cursor_.take((size - offset % size) % size);
  }

  ByteCursor cursor_;
  RosEncoding encoding_;
  bool is_known_{true};
};

bool are_finite(std::initializer_list<double> numbers) {
  return std::ranges::all_of(numbers, [](double number) { return std::isfinite(number); });
}

std::optional<Eigen::Quaterniond> rotation(const std::array<double, 4>& xyzw) {
  const Eigen::Quaterniond q{xyzw[3], xyzw[0], xyzw[1], xyzw[2]};
  const double norm = q.norm();
  constexpr double kTolerance = 0.1;  // some drivers round coarsely
  if (!(std::abs(norm - 1.0) < kTolerance)) return std::nullopt;
  return q.normalized();
}

}  // namespace

std::optional<RosScan> read_scan(const RosRecord& record) {
  RosCursor cursor{record};
  RosScan scan;
  scan.header = cursor.header();
  scan.angle_min_rad = cursor.number<float>();
  cursor.number<float>();  // angle_max: follows from the others
  scan.angle_increment_rad = cursor.number<float>();
  scan.time_increment_s = cursor.number<float>();
  cursor.number<float>();  // scan_time
  scan.range_min_m = cursor.number<float>();
  scan.range_max_m = cursor.number<float>();
  scan.ranges_m = cursor.list<float>();
  const bool is_sane = are_finite({scan.angle_min_rad, scan.angle_increment_rad,
                                   scan.time_increment_s, scan.range_min_m}) &&
                       !std::isnan(scan.range_max_m) && scan.angle_increment_rad != 0.0F;
  if (!cursor.good() || !is_sane) return std::nullopt;
  return scan;
}

std::optional<RosOdometry> read_odometry(const RosRecord& record) {
  RosCursor cursor{record};
  RosOdometry odometry;
  odometry.header = cursor.header();
  odometry.child_frame = cursor.text();
  const auto position = cursor.doubles<3>();
  const auto turn = rotation(cursor.doubles<4>());
  if (!cursor.good() || !turn || !are_finite({position[0], position[1]})) return std::nullopt;
  const Eigen::Vector3d forward = *turn * Eigen::Vector3d::UnitX();
  odometry.pose = {Eigen::Vector2d{position[0], position[1]}, std::atan2(forward.y(), forward.x())};
  return odometry;
}

std::optional<RosImage> read_compressed_image(const RosRecord& record) {
  RosCursor cursor{record};
  RosImage image;
  image.header = cursor.header();
  image.format = cursor.text();
  image.data = cursor.block();
  if (!cursor.good() || image.data.empty()) return std::nullopt;
  return image;
}

std::optional<RosImage> read_image(const RosRecord& record) {
  RosCursor cursor{record};
  RosImage image;
  image.header = cursor.header();
  const auto height = cursor.number<std::uint32_t>();
  const auto width = cursor.number<std::uint32_t>();
  image.format = cursor.text();
  cursor.number<std::uint8_t>();  // is_bigendian: matters for multi-byte pixels only
  const auto step = cursor.number<std::uint32_t>();
  image.data = cursor.block();
  const bool is_sane = width > 0 && height > 0 && width <= kMaxSide_px && height <= kMaxSide_px &&
                       std::uint64_t{step} * height <= image.data.size();
  if (!cursor.good() || !is_sane) return std::nullopt;
  image.width_px = static_cast<int>(width);
  image.height_px = static_cast<int>(height);
  image.row_bytes = static_cast<int>(step);
  return image;
}

std::optional<RosCameraInfo> read_camera_info(const RosRecord& record) {
  RosCursor cursor{record};
  RosCameraInfo info;
  info.header = cursor.header();
  const auto height = cursor.number<std::uint32_t>();
  const auto width = cursor.number<std::uint32_t>();
  info.distortion_model = cursor.text();
  info.distortion = cursor.list<double>();
  info.camera_matrix = cursor.doubles<9>();
  cursor.doubles<9>();  // rectification
  info.projection = cursor.doubles<12>();
  const bool is_sane =
      width <= kMaxSide_px && height <= kMaxSide_px &&
      std::ranges::all_of(info.camera_matrix, [](double d) { return std::isfinite(d); }) &&
      std::ranges::all_of(info.distortion, [](double d) { return std::isfinite(d); });
  if (!cursor.good() || !is_sane) return std::nullopt;
  info.width_px = static_cast<int>(width);
  info.height_px = static_cast<int>(height);
  return info;
}

std::optional<RosTransforms> read_transforms(const RosRecord& record) {
  RosCursor cursor{record};
  RosTransforms transforms;
  const auto count = cursor.number<std::uint32_t>();
  for (std::uint32_t i = 0; i < count && cursor.good(); ++i) {
    RosTransform transform;
    transform.parent = cursor.header().frame;
    transform.child = cursor.text();
    const auto position = cursor.doubles<3>();
    const auto turn = rotation(cursor.doubles<4>());
    if (!cursor.good()) break;
    if (!turn || !are_finite({position[0], position[1], position[2]})) {
      transforms.bad.push_back(std::move(transform.child));
      continue;
    }
    transform.parent_from_child.translation() =
        Eigen::Vector3d{position[0], position[1], position[2]};
    transform.parent_from_child.linear() = turn->toRotationMatrix();
    transforms.good.push_back(std::move(transform));
  }
  if (!cursor.good()) return std::nullopt;
  return transforms;
}

}  // namespace waymark
