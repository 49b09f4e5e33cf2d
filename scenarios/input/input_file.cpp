#include "scenarios/input/input_file.h"

#include <fcntl.h>
#include <libdeflate.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <new>
#include <system_error>
#include <utility>

#include "scenarios/input/inputs_read.h"

namespace lcs::input {
namespace {

constexpr std::size_t kBlock = 1 << 16;
/// Ten times a frame of 100,000 corners; only a file without line ends exceeds it.
constexpr std::size_t kLongestLine = 256 * kMebibyte;
/// A member of a gzip file is in memory as a whole. This program's members are of 1 MiB; `gzip`
/// makes one of a whole file.
constexpr std::size_t kLargestMember = kGibibyte;

std::string size_text(std::uint64_t bytes) {
  return bytes % kGibibyte == 0 ? std::to_string(bytes / kGibibyte) + " GiB"
                                : std::to_string(bytes / kMebibyte) + " MiB";
}

}  // namespace

InputFile::InputFile(const std::filesystem::path& file, const FileKind& kind)
    : InputFile(file, kind, {file.string(), 0}) {}

InputFile::InputFile(const std::filesystem::path& file, const FileKind& kind, const Source& where)
    : file_(file.string()), kind_(kind), where_(where), is_gzip_(file.extension() == ".gz") {
  struct stat status = {};
  // Check before opening, too: opening alone wakes a pipe's writer, or moves a tape.
  if (::stat(file_.c_str(), &status) != 0) fail(errno);
  check(status);
  // Without O_NONBLOCK, open would block on a pipe created since the check.
  descriptor_ = Descriptor(::open(file_.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
  if (!descriptor_.is_open() || ::fstat(descriptor_.get(), &status) != 0) fail(errno);
  check(status);
  note_input(file);
  if (is_gzip_) buffer_.reserve(static_cast<std::size_t>(status.st_size) + kBlock);
}

void InputFile::fail(const std::string& what, std::string_view remedy) const {
  const std::string name = where_.file == file_ ? "" : "'" + file_ + "': ";
  throw Error(where_, name + what + "; " + std::string(remedy));
}

void InputFile::fail(int error) const {
  if (error == EIO) {  // a fault of the disk, not of the file: nobody may take it for a bad input
    throw std::system_error(error, std::generic_category(), file_ + " cannot be read");
  }
  if (error == ENOENT || error == ENOTDIR) fail("there is no such file", kind_.remedy);
  if (error == EACCES || error == EPERM) fail("the file cannot be read", "check its permissions");
  if (error == EMFILE || error == ENFILE) {
    fail("the file cannot be opened beside so many others",
         "raise the limit of open files (ulimit -n)");
  }
  fail("the file cannot be read (" + std::generic_category().message(error) + ")", kind_.remedy);
}

void InputFile::check(const struct stat& status) const {
  if (S_ISREG(status.st_mode)) return check_size(static_cast<std::uint64_t>(status.st_size));
  if (S_ISFIFO(status.st_mode)) {
    fail("this is a pipe, which may never end", "write what comes out of it to a file first");
  }
  fail(S_ISDIR(status.st_mode)    ? "this is a folder"
       : S_ISSOCK(status.st_mode) ? "this is a socket"
                                  : "this is a device",
       kind_.remedy);
}

void InputFile::check_size(std::uint64_t bytes) const {
  if (bytes <= kind_.most_bytes) return;
  fail("the file is larger than " + size_text(kind_.most_bytes), kind_.remedy);
}

bool InputFile::fill() {
  buffer_.erase(0, used_);
  used_ = 0;
  if (!is_gzip_) return read_block();
  if (compressed_.empty()) {
    while (read_block()) {
    }
    compressed_ = std::exchange(buffer_, {});
    read_ = 0;
    if (compressed_.empty()) fail("the file is empty, which no gzip file is", kind_.remedy);
  }
  return decompress();
}

bool InputFile::decompress() {
  if (decompressed_ == compressed_.size()) return false;
  const std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)> gzip(
      libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
  if (!gzip) throw std::bad_alloc();
  std::size_t taken = 0, given = 0;
  for (;; room_ *= 2, member_.reset()) {
    if (!member_) member_ = std::make_unique_for_overwrite<char[]>(room_);
    const libdeflate_result result = libdeflate_gzip_decompress_ex(
        gzip.get(), compressed_.data() + decompressed_, compressed_.size() - decompressed_,
        member_.get(), room_, &taken, &given);
    if (result == LIBDEFLATE_SUCCESS) break;
    if (result != LIBDEFLATE_INSUFFICIENT_SPACE) fail("this is no whole gzip file", kind_.remedy);
    check_size(read_ + room_);
    if (room_ >= kLargestMember) {
      fail("the file has " + size_text(kLargestMember) + " or more in one gzip member",
           "decompress it (gunzip)");
    }
  }
  buffer_.append(member_.get(), given);
  decompressed_ += taken;
  read_ += given;
  check_size(read_);
  return true;
}

bool InputFile::read_block() {
  const std::size_t before = buffer_.size();
  buffer_.resize(before + kBlock);
  ssize_t got = 0;
  do {
    got = ::read(descriptor_.get(), buffer_.data() + before, kBlock);
  } while (got < 0 && errno == EINTR);
  const int error = errno;
  buffer_.resize(before + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
  if (got < 0) fail(error);
  read_ += static_cast<std::uint64_t>(got);
  check_size(read_);  // the file may have grown
  return got > 0;
}

std::string InputFile::bytes() {
  while (fill()) {
  }
  return std::move(buffer_);
}

std::string InputFile::bytes_at(std::uint64_t offset, std::size_t count) const {
  std::string bytes(count, '\0');
  std::size_t read = 0;
  while (read < count) {
    const ssize_t got = ::pread(descriptor_.get(), bytes.data() + read, count - read,
                                static_cast<off_t>(offset + read));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail(errno);
    if (got == 0) break;
    read += static_cast<std::size_t>(got);
  }
  bytes.resize(read);
  return bytes;
}

bool InputFile::next_line(std::string& line) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  std::size_t end = buffer_.find('\n', used_);
  while (end == std::string::npos) {
    const std::size_t seen = buffer_.size() - used_;
    if (seen > kLongestLine) fail("a line is longer than " + size_text(kLongestLine), kind_.remedy);
    if (!fill()) break;
    end = buffer_.find('\n', seen);
  }
  const bool is_last = end == std::string::npos;
  if (is_last && used_ == buffer_.size()) return false;
  const std::size_t stop = is_last ? buffer_.size() : end;
  line.assign(buffer_, used_, stop - used_);
  used_ = is_last ? stop : stop + 1;
  if (++line_ == 1 && line.starts_with(kByteOrderMark)) line.erase(0, kByteOrderMark.size());
  return true;
}

std::string read_file(const std::filesystem::path& file, const FileKind& kind) {
  return InputFile(file, kind).bytes();
}

}  // namespace lcs::input
