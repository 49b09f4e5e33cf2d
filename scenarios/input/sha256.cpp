#include "scenarios/input/sha256.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <openssl/evp.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <memory>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "scenarios/input/descriptor.h"
#include "scenarios/input/error.h"

namespace lcs::input {
namespace {

class Sha256 {
 public:
  Sha256() : context_(EVP_MD_CTX_new()) {
    require(context_ && EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1);
  }
  void add(const char* bytes, std::size_t count) {
    require(EVP_DigestUpdate(context_.get(), bytes, count) == 1);
  }
  std::string text() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest;
    unsigned int size = 0;
    require(EVP_DigestFinal_ex(context_.get(), digest.data(), &size) == 1);
    return fmt::format("{:02x}", fmt::join(digest.data(), digest.data() + size, ""));
  }

 private:
  struct Free {
    void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
  };
  static void require(bool is_fine) {
    if (!is_fine) throw std::runtime_error("OpenSSL does not compute SHA-256");
  }
  std::unique_ptr<EVP_MD_CTX, Free> context_;
};

}  // namespace

std::string sha256(std::string_view bytes) {
  Sha256 digest;
  digest.add(bytes.data(), bytes.size());
  return digest.text();
}

std::optional<std::string> sha256_of_file(const std::filesystem::path& path) {
  const auto fail = [&](int error) {
    if (error == EIO) throw std::system_error(error, std::generic_category(), path.string());
    const bool are_too_many = error == EMFILE || error == ENFILE;
    throw Error({path.string(), 0}, "the file cannot be read ({}); {}",
                std::generic_category().message(error),
                are_too_many ? "raise the limit of open files (ulimit -n)"
                             : "check its permissions, and try again");
  };
  const Descriptor file(
      ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
  if (!file.is_open() &&
      (errno == ENOENT || errno == ENOTDIR || errno == ELOOP || errno == ENXIO)) {
    return std::nullopt;
  }
  if (!file.is_open()) fail(errno);
  struct stat status = {};
  const bool is_regular = ::fstat(file.get(), &status) == 0 && S_ISREG(status.st_mode);
  Sha256 digest;
  std::vector<char> block(is_regular ? 1 << 20 : 0);
  for (ssize_t got = 1; is_regular && got != 0;) {
    got = ::read(file.get(), block.data(), block.size());
    if (got > 0) digest.add(block.data(), static_cast<std::size_t>(got));
    if (got < 0 && errno != EINTR) fail(errno);
  }
  return is_regular ? std::optional(digest.text()) : std::nullopt;
}

}  // namespace lcs::input
