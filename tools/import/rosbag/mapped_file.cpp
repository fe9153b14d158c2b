// SPDX-License-Identifier: BSD-3-Clause
#include "import/rosbag/mapped_file.hpp"

#include "common/errors/setup_error.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace waymark {

MappedFile::MappedFile(const std::filesystem::path& file) {
  const auto fail = [&file] {
    throw SetupError{file.string() + ": cannot be read"};
  };
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) fail();

  struct stat status {};

  const bool has_size = ::fstat(descriptor, &status) == 0;
  const auto size = static_cast<std::size_t>(status.st_size);
  void* const start = has_size && size > 0
                          ? ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor, 0)
                          : MAP_FAILED;
  ::close(descriptor);
  if (start == MAP_FAILED) fail();
  bytes_ = {static_cast<const std::uint8_t*>(start), size};
}

MappedFile::~MappedFile() {
  ::munmap(const_cast<std::uint8_t*>(bytes_.data()), bytes_.size());
}

}  // namespace waymark
