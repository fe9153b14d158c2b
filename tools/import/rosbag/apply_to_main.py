import re
def sub(path, pairs):
    s=open(path).read()
    for a,b in pairs:
        assert a in s, (path,a)
        s=s.replace(a,b,1)
    open(path,'w').write(s)
sub('tools/import/log/imported_log.hpp',[('''  RobotConfig robot{};
''','''  std::vector<Message> images{};  ///< for the channel CAMERA
  RobotConfig robot{};
''')])
sub('tools/import/log/log_output.cpp',[('''  std::ranges::sort(messages, comes_before);
''','''  messages.insert(messages.end(), log.images.begin(), log.images.end());
  std::ranges::sort(messages, comes_before);
'''),
('''  line("duration",''','''  if (!log.images.empty()) line("images", fmt::format("{}", log.images.size()));
  line("duration",''')])
sub('tools/import/main.cpp',[
('#include "import/mbot/mbot_reader.hpp"\n','#include "import/mbot/mbot_reader.hpp"\n#include "import/rosbag/rosbag_reader.hpp"\n'),
('  MbotOptions mbot{};\n','  MbotOptions mbot{};\n  RosbagOptions rosbag{};\n'),
('''/// What both kinds of logs have.
void add_common_options(CLI::App& app, Options& options, LidarMounting& mounting,
                        double& range_min_m) {''','''/// What all kinds of logs have.
void add_common_options(CLI::App& app, Options& options, LidarMounting& mounting) {'''),
('''  app.add_option("--min-range-m", range_min_m, "shortest range measured")
      ->check(nonnegative_number())
      ->capture_default_str();
  app.add_option("--lidar-x-m"''','''  app.add_option("--lidar-x-m"'''),
('''CLI::App* add_carmen(''','''/// Of logs whose scans do not say it.
void add_range_min(CLI::App& app, double& range_min_m) {
  app.add_option("--min-range-m", range_min_m, "shortest range measured")
      ->check(nonnegative_number())
      ->capture_default_str();
}

CLI::App* add_carmen('''),
('  add_common_options(*carmen, options, options.carmen.mounting, options.carmen.range_min_m);','  add_common_options(*carmen, options, options.carmen.mounting);\n  add_range_min(*carmen, options.carmen.range_min_m);'),
('  add_common_options(*mbot, options, chosen.mounting, chosen.range_min_m);','  add_common_options(*mbot, options, chosen.mounting);\n  add_range_min(*mbot, chosen.range_min_m);'),
('''void convert_angles(Options& options) {''','''CLI::App* add_rosbag(CLI::App& app, Options& options) {
  CLI::App* rosbag = app.add_subcommand(
      "rosbag", "bag of ROS 1 (.bag) or ROS 2 (.db3, .mcap): LaserScan, Odometry, images, tf_static");
  RosbagOptions& chosen = options.rosbag;
  add_common_options(*rosbag, options, chosen.mounting);
  rosbag->add_option("--scan-topic", chosen.scan_topic,
                     "sensor_msgs/LaserScan (default: the only one)");
  rosbag->add_option("--odometry-topic", chosen.odometry_topic,
                     "nav_msgs/Odometry (default: the only one)");
  rosbag->add_option("--image-topic", chosen.image_topic,
                     "sensor_msgs/CompressedImage or Image (default: the only one, if any)");
  rosbag->add_option("--camera-info-topic", chosen.camera_info_topic,
                     "sensor_msgs/CameraInfo (default: the only one)");
  rosbag->add_flag("--no-images", chosen.without_images, "leave the camera out");
  rosbag->add_option("--base-frame", chosen.base_frame,
                     "frame of the base in tf_static (default: the child frame of odometry)");
  return rosbag;
}

void convert_angles(Options& options) {'''),
('options.carmen.mounting.yaw_rad = options.mbot.mounting.yaw_rad = wrap_angle(*yaw_rad);','options.carmen.mounting.yaw_rad = options.mbot.mounting.yaw_rad =\n        options.rosbag.mounting.yaw_rad = wrap_angle(*yaw_rad);'),
('''int import(const Options& options, bool is_carmen) {''','''enum class Kind { kCarmen, kMbot, kRosbag };

ImportedLog read(const Options& options, Kind kind, ImportReport& report) {
  if (kind == Kind::kCarmen) return read_carmen_log(options.file, options.carmen, report);
  if (kind == Kind::kMbot) return read_mbot_log(options.file, options.mbot, report);
  return read_rosbag(options.file, options.rosbag, report);
}

int import(const Options& options, Kind kind) {'''),
('is_carmen ? AddressUnit::kLine : AddressUnit::kByte}','kind == Kind::kCarmen ? AddressUnit::kLine : AddressUnit::kByte}'),
('''    ImportedLog log = is_carmen ? read_carmen_log(options.file, options.carmen, report)
                                : read_mbot_log(options.file, options.mbot, report);
''','''    ImportedLog log = read(options, kind, report);
'''),
('''  add_mbot(app, options);
''','''  add_mbot(app, options);
  const CLI::App* rosbag = add_rosbag(app, options);
'''),
('''  return run_guarded(kTraits, [&] { return import(options, carmen->parsed()); });''','''  const Kind kind = carmen->parsed()   ? Kind::kCarmen
                    : rosbag->parsed() ? Kind::kRosbag
                                       : Kind::kMbot;
  return run_guarded(kTraits, [&] { return import(options, kind); });'''),
])
s=open('tools/import/CMakeLists.txt').read()
s=s.replace('find_package(BZip2 REQUIRED)\n','''find_package(BZip2 REQUIRED)
find_package(SQLite3 REQUIRED)
pkg_check_modules(bag_compression REQUIRED IMPORTED_TARGET liblz4 libzstd)
''')
s=re.sub(r'(mbot/wheel_odometry.cpp)\n',r'''\1
          rosbag/bag.cpp rosbag/camera_image.cpp rosbag/db3_bag.cpp rosbag/decompress.cpp
          rosbag/mapped_file.cpp rosbag/mcap_bag.cpp rosbag/ros1_bag.cpp rosbag/ros_messages.cpp
          rosbag/rosbag_reader.cpp rosbag/static_frames.cpp
''',s,1)
s=s.replace('BZip2::BZip2 ZLIB::ZLIB)','BZip2::BZip2 ZLIB::ZLIB\n            PkgConfig::bag_compression SQLite::SQLite3 opencv_imgcodecs opencv_imgproc)',1)
open('tools/import/CMakeLists.txt','w').write(s)
sub('deploy/install-deps.sh',[('  zlib1g-dev libbz2-dev                    # import of compressed CARMEN logs\n','  zlib1g-dev libbz2-dev                    # import of compressed logs, export\n  libsqlite3-dev libzstd-dev liblz4-dev    # import of ROS bags\n')])
sub('tests/python/CMakeLists.txt',[('arrays report mcap)','arrays report mcap rosbag)'),('python_package waymark-export)','python_package waymark-export waymark-import)')])
