// SPDX-License-Identifier: BSD-3-Clause
// Detector against truth: the simulator's own pictures of the default corridor from random poses,
// raw and compressed. Usage: detector_accuracy [poses per distance] [seed] [key=value ...]
// Keys are those of a scenario, and detector.*.
// Distances are along the corridor from the camera to the marker's centre; only markers whose black
// square is wholly in view, with the quiet zone's width to spare, count.
#include "common/config/config.hpp"
#include "common/geometry/angle.hpp"
#include "common/geometry/median.hpp"
#include "common/random/random.hpp"
#include "detector/core/frame_decoder.hpp"
#include "detector/core/marker_detector.hpp"
#include "detector/core/square_pose.hpp"
#include "detector/detector_config.hpp"
#include "sim/core/camera/camera.hpp"
#include "sim/core/camera/renderer.hpp"
#include "sim/core/scenario.hpp"
#include "sim/core/world/mjcf.hpp"

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <string>
#include <vector>

namespace waymark {
namespace {

constexpr std::array kDistancesM{1.9, 2.1, 2.3, 2.5, 2.7, 2.9, 3.1, 3.3, 3.5, 3.9, 4.3};
constexpr double kIssueFarthestM = 3.5;

/// Detected minus true corners, summed over sightings, clockwise from the marker's top left.
struct CornerErrors {
  int markers{0};
  std::array<Eigen::Vector2d, 4> sum_px{Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero(),
                                        Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};

  void merge(const CornerErrors& other) {
    markers += other.markers;
    for (std::size_t k = 0; k < sum_px.size(); ++k)
      sum_px[k] += other.sum_px[k];
  }
};

/// What is known after many sightings at one distance.
struct Tally {
  int markers{0};
  int detected{0};
  int unrefined{0};
  int false_ids{0};
  double range_sum_m{0.0};
  double range_squares{0.0};
  double bearing_squares{0.0};
  double yaw_squares{0.0};
  double nees_sum{0.0};
  CornerErrors left_wall{};
  CornerErrors right_wall{};
  std::vector<double> milliseconds{};

  void merge(const Tally& other) {
    markers += other.markers;
    detected += other.detected;
    unrefined += other.unrefined;
    false_ids += other.false_ids;
    range_sum_m += other.range_sum_m;
    range_squares += other.range_squares;
    bearing_squares += other.bearing_squares;
    yaw_squares += other.yaw_squares;
    nees_sum += other.nees_sum;
    left_wall.merge(other.left_wall);
    right_wall.merge(other.right_wall);
    milliseconds.insert(milliseconds.end(), other.milliseconds.begin(), other.milliseconds.end());
  }
};

/// Processor time: other processes on the machine do not count.
double cpu_ms() {
  return 1000.0 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

double yaw_of_normal(const Eigen::Isometry3d& base_from_marker) {
  return std::atan2(base_from_marker.linear()(1, 2), base_from_marker.linear()(0, 2));
}

Eigen::Isometry3d world_from_marker(const MarkerPlate& plate) {
  const Eigen::Vector3d out{std::cos(plate.yaw_rad), std::sin(plate.yaw_rad), 0.0};
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = plate.centre_m;
  pose.linear().col(0) = Eigen::Vector3d::UnitZ().cross(out);
  pose.linear().col(1) = Eigen::Vector3d::UnitZ();
  pose.linear().col(2) = out;
  return pose;
}

/// The scenario's corridor, camera and detector.
class Bench {
 public:
  Bench(const Scenario& scenario, const MarkerDetectorConfig& detector)
      : scenario_{scenario},
        world_{build_world(scenario.world, scenario.markers, plate_size_m(scenario.marker_print()),
                           scenario.run.seed)},
        camera_{scenario.robot.camera, scenario.camera_noise, scenario.run.seed},
        physics_{mjcf()},
        renderer_{world_, scenario.marker_print(), PlatePrint::kMarkers, camera_.pinhole(),
                  physics_},
        model_{scenario.robot.camera},
        detector_{scenario.robot, detector} {}

  const World& world() const { return world_; }

  /// Adds one picture, raw and compressed, of a plate from about that distance.
  void look_at(const MarkerPlate& plate, double distance_m, Random& random, Tally& raw,
               Tally& compressed) {
    const CameraConfig& camera = scenario_.robot.camera;
    Eigen::Isometry3d world_from_base = Eigen::Isometry3d::Identity();
    world_from_base.linear() =
        Eigen::AngleAxisd{radians(random.uniform(-4, 4)), Eigen::Vector3d::UnitZ()}
            .toRotationMatrix();
    world_from_base.translation() =
        Eigen::Vector3d{plate.centre_m.x() - distance_m - camera.x_m + random.uniform(-0.1, 0.1),
                        random.uniform(-0.1, 0.1), 0.0};
    const Eigen::Isometry3d truth = world_from_base.inverse() * world_from_marker(plate);
    if (!wholly_in_view(truth)) return;

    const cv::Mat picture =
        camera_.expose(renderer_.render(world_from_base * camera.base_from_camera()), frames_++);
    evaluate(plate.id, truth, picture, raw);
    const CameraFrame frame = camera_.compress(picture, Timestamp{});
    smallest_quality_ = std::min(smallest_quality_, frame.jpeg_quality);
    evaluate_compressed(plate.id, truth, frame, compressed);
  }

  int smallest_quality() const { return smallest_quality_; }

 private:
  std::string mjcf() const {
    MjcfOptions options;
    options.plate_size_m = plate_size_m(scenario_.marker_print());
    options.picture_width_px = camera_.pinhole().width_px;
    options.picture_height_px = camera_.pinhole().height_px;
    return to_mjcf(world_, scenario_.robot, options);
  }

  bool wholly_in_view(const Eigen::Isometry3d& base_from_marker) const {
    const CameraConfig& camera = scenario_.robot.camera;
    const double half_m = 0.5 * plate_size_m(scenario_.marker_print());
    for (const double x : {-half_m, half_m}) {
      for (const double y : {-half_m, half_m}) {
        const Eigen::Vector3d corner =
            camera.base_from_camera().inverse() * base_from_marker * Eigen::Vector3d{x, y, 0.0};
        if (corner.z() < 0.1) return false;
        const Eigen::Vector2d pixel = model_.raw_from_ideal(model_.project(corner));
        if (pixel.x() < 0 || pixel.y() < 0 || pixel.x() > camera.width_px - 1 ||
            pixel.y() > camera.height_px - 1) {
          return false;
        }
      }
    }
    return true;
  }

  void evaluate_compressed(int id, const Eigen::Isometry3d& truth, const CameraFrame& frame,
                           Tally& tally) {
    const double start_ms = cpu_ms();
    const DecodedFrame decoded =
        decode_frame({PixelFormat::kMjpeg, frame.width_px, frame.height_px, 0, frame.jpeg},
                     {frame.width_px, frame.height_px});
    const double decoding_ms = cpu_ms() - start_ms;
    evaluate(id, truth, decoded.gray, tally);
    tally.milliseconds.back() += decoding_ms;
  }

  void evaluate(int id, const Eigen::Isometry3d& truth, const cv::Mat& gray, Tally& tally) {
    const double start_ms = cpu_ms();
    const auto detections = detector_.detect(gray);
    tally.milliseconds.push_back(cpu_ms() - start_ms);
    ++tally.markers;
    for (const MarkerDetection& seen : detections) {
      const bool exists = std::ranges::any_of(
          world_.markers, [&seen](const MarkerPlate& plate) { return plate.id == seen.id; });
      if (!exists) ++tally.false_ids;
      if (seen.id == id) compare(seen, truth, tally);
    }
  }

  void compare(const MarkerDetection& seen, const Eigen::Isometry3d& truth, Tally& tally) const {
    const Eigen::Vector3d camera_in_base = scenario_.robot.camera.base_from_camera().translation();
    const Eigen::Vector3d to_seen = seen.base_from_marker.translation() - camera_in_base;
    const Eigen::Vector3d to_truth = truth.translation() - camera_in_base;
    const double range_error_m = to_seen.norm() - to_truth.norm();
    const double bearing_error_rad = angle_difference(std::atan2(to_seen.y(), to_seen.x()),
                                                      std::atan2(to_truth.y(), to_truth.x()));
    const double yaw_error_rad =
        angle_difference(yaw_of_normal(seen.base_from_marker), yaw_of_normal(truth));
    const Eigen::AngleAxisd turn{seen.base_from_marker.linear() * truth.linear().transpose()};
    Eigen::Matrix<double, 6, 1> error;
    error << seen.base_from_marker.translation() - truth.translation(), turn.angle() * turn.axis();

    ++tally.detected;
    // Unrefined corners have 0.8 px; no refined marker in this band comes near their covariance.
    if (seen.covariance_in_base(1, 1) > 0.005 * 0.005) ++tally.unrefined;
    tally.range_sum_m += range_error_m;
    tally.range_squares += range_error_m * range_error_m;
    tally.bearing_squares += bearing_error_rad * bearing_error_rad;
    tally.yaw_squares += yaw_error_rad * yaw_error_rad;
    tally.nees_sum += error.dot(seen.covariance_in_base.ldlt().solve(error));
    add_corners(seen, truth, truth.translation().y() > 0.0 ? tally.left_wall : tally.right_wall);
  }

  void add_corners(const MarkerDetection& seen, const Eigen::Isometry3d& truth,
                   CornerErrors& errors) const {
    const auto corners_m = corners_in_marker(scenario_.robot.markers.size_m);
    ++errors.markers;
    for (std::size_t k = 0; k < 4; ++k) {
      const Eigen::Vector3d corner =
          scenario_.robot.camera.base_from_camera().inverse() * truth * corners_m[k];
      errors.sum_px[k] += seen.corners_px[k] - model_.raw_from_ideal(model_.project(corner));
    }
  }

  Scenario scenario_;
  World world_;
  Camera camera_;
  Physics physics_;
  Renderer renderer_;
  CameraModel model_;
  MarkerDetector detector_;
  std::uint64_t frames_{0};
  int smallest_quality_{100};
};

void print_row(const std::string& name, const Tally& tally) {
  const double n = std::max(1, tally.detected);
  fmt::print(
      "{:>9} {:7} {:7.1f} {:9} {:8} {:+8.3f} {:8.3f} {:9.4f} {:8.3f} {:6.1f} {:6.1f}\n", name,
      tally.markers, 100.0 * tally.detected / std::max(1, tally.markers), tally.unrefined,
      tally.false_ids, 100.0 * tally.range_sum_m / n, 100.0 * std::sqrt(tally.range_squares / n),
      degrees(std::sqrt(tally.bearing_squares / n)), degrees(std::sqrt(tally.yaw_squares / n)),
      tally.nees_sum / n, tally.milliseconds.empty() ? 0.0 : median(tally.milliseconds));
}

/// Mean errors, which all markers of a corridor have in common.
void print_corners(const std::string& wall, const CornerErrors& errors) {
  std::string text;
  for (const Eigen::Vector2d& sum : errors.sum_px) {
    const Eigen::Vector2d mean = sum / std::max(1, errors.markers);
    text += fmt::format("   {:+.4f} {:+.4f}", mean.x(), mean.y());
  }
  fmt::print("mean error of the corners [px], {:>5} wall, clockwise from top left, u v:{}\n", wall,
             text);
}

void print_table(const std::string& title, const std::vector<Tally>& tallies) {
  fmt::print("\n{}\n{:>9} {:>7} {:>7} {:>9} {:>8} {:>8} {:>8} {:>9} {:>8} {:>6} {:>6}\n", title,
             "distance", "markers", "found %", "unrefined", "false id", "bias cm", "range cm",
             "bearing d", "yaw deg", "NEES/6", "ms");
  Tally band;
  for (std::size_t i = 0; i < kDistancesM.size(); ++i) {
    print_row(fmt::format("{:.1f} m", kDistancesM[i]), tallies[i]);
    if (kDistancesM[i] <= kIssueFarthestM) band.merge(tallies[i]);
  }
  print_row("1.9-3.5 m", band);
  print_corners("left", band.left_wall);
  print_corners("right", band.right_wall);
}

void run(int poses, std::uint64_t seed, std::vector<std::string> overrides) {
  const auto detector_keys = std::ranges::stable_partition(
      overrides, [](const std::string& key) { return !key.starts_with("detector."); });
  const std::vector<std::string> of_detector{detector_keys.begin(), detector_keys.end()};
  const std::vector<std::string> of_scenario{overrides.begin(), detector_keys.begin()};
  Bench bench{load_config<Scenario>({{}, of_scenario}),
              load_config<DetectorConfig>({{}, of_detector}).detector};
  const std::vector<MarkerPlate>& plates = bench.world().markers;
  std::vector<Tally> raw(kDistancesM.size());
  std::vector<Tally> compressed(kDistancesM.size());
  for (std::size_t i = 0; i < kDistancesM.size(); ++i) {
    for (int pose = 0; pose < poses; ++pose) {
      Random random{seed, i, static_cast<std::uint64_t>(pose)};
      bench.look_at(plates[random() % plates.size()], kDistancesM[i], random, raw[i],
                    compressed[i]);
    }
  }
  print_table("without JPEG", raw);
  print_table(fmt::format("with JPEG (lowest quality needed {}), ms with decoding",
                          bench.smallest_quality()),
              compressed);
}

}  // namespace
}  // namespace waymark

int main(int argc, char** argv) {
  try {
    cv::setNumThreads(1);
    const int poses = argc > 1 ? std::stoi(argv[1]) : 100;
    const std::uint64_t seed = argc > 2 ? std::stoull(argv[2]) : 1;
    waymark::run(poses, seed, std::vector<std::string>(argv + std::min(argc, 3), argv + argc));
  } catch (const std::exception& error) {
    fmt::print(stderr, "detector_accuracy: {}\n", error.what());
    return 2;
  }
}
