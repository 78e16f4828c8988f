#include "files/bag_structure.hpp"

#include <bzlib.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <roslz4/lz4s.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>

#include "files/byte_reader.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::files {
namespace {

constexpr Bytes kFirstLine = "#ROSBAG V2.0\n";
constexpr std::uint64_t kLargestChunk = 1u << 30;  // bytes unpacked; scans have some tens of millions
// Bytes of all chunks unpacked may be so many, or so many times the file's: LZ4 makes at most 255 of 1.
constexpr std::uint64_t kAlwaysAllowed = 1u << 28, kLargestRatio = 300;
enum Op : std::uint8_t { kMessage = 2, kBag = 3, kIndex = 4, kChunk = 5, kChunkInfo = 6, kConnection = 7 };

/// name=value pairs.
class Fields {
 public:
  explicit Fields(Bytes header) {
    while (!header.empty()) {
      const Bytes field = take_block(header);
      const std::size_t sign = field.find('=');
      check(sign != Bytes::npos && sign > 0, "has a header field without a name");
      check(values_.emplace(field.substr(0, sign), field.substr(sign + 1)).second,
            "has a header field twice");
    }
  }
  Bytes text(Bytes name) const {
    const auto found = values_.find(name);
    check(found != values_.end(), "lacks a header field");
    return found->second;
  }
  bool has(Bytes name) const { return values_.count(name) != 0; }
  template <typename Number>
  Number number(Bytes name) const {
    return number_in<Number>(text(name));
  }

 private:
  std::map<Bytes, Bytes> values_;
};

struct Record {
  Fields header;
  Bytes data;
  Op op;
};

Record take_record(Bytes& rest) {
  const Fields header(take_block(rest));
  const Bytes data = take_block(rest);
  return {header, data, static_cast<Op>(header.number<std::uint8_t>("op"))};
}

// The blocks of an LZ4 frame: roslz4 copies one that is not compressed without a look at its own buffer.
void check_lz4(Bytes frame) {
  const Bytes head = take(frame, 7);  // magic number, flags, sizes of blocks, checksum
  const int size = static_cast<unsigned char>(head[5]) >> 4 & 7;
  check(size >= 4, "has an LZ4 chunk of unknown block size");
  const std::uint64_t limit = std::uint64_t{1} << (8 + 2 * size);  // 64 kB, 256 kB, 1 MB, 4 MB
  constexpr std::uint32_t kIsPlain = 1u << 31;
  while (const std::uint32_t length = take_length(frame) & ~kIsPlain) {
    check(length <= limit, "has an LZ4 block that is larger than its blocks are");
    take(frame, length);
  }
  take(frame, 4);  // checksum of the whole
  check(frame.empty(), "has bytes after an LZ4 chunk");
}

std::string unpacked(Bytes packed, Bytes compression, std::uint64_t size) {
  check(size <= kLargestChunk, "has a chunk that is too large");
  if (compression == "lz4") check_lz4(packed);
  std::string bytes(size, '\0');
  auto length = static_cast<unsigned int>(size);
  const auto packed_length = static_cast<unsigned int>(packed.size());
  char* from = const_cast<char*>(packed.data());  // neither library writes there
  const bool whole =
      compression == "bz2"
          ? BZ2_bzBuffToBuffDecompress(bytes.data(), &length, from, packed_length, 0, 0) == BZ_OK
          : roslz4_buffToBuffDecompress(from, packed_length, bytes.data(), &length) == ROSLZ4_OK;
  check(whole && length == size, "has a chunk that cannot be unpacked");
  return bytes;
}

class Walk {
 public:
  explicit Walk(Bytes file) : file_(file) {}

  void whole() {
    Bytes rest = file_;
    check(take(rest, std::min(rest.size(), kFirstLine.size())) == kFirstLine, "is no bag of version 2.0");
    const Record bag = take_record(rest);
    check(bag.op == kBag, "does not begin with a bag's header");
    check(!bag.header.has("encryptor"), "is encrypted");
    index_ = bag.header.number<std::uint64_t>("index_pos");
    const auto connections = bag.header.number<std::uint32_t>("conn_count"),
               chunks = bag.header.number<std::uint32_t>("chunk_count");
    if (index_ == 0) return;  // cut off: rosbag reads no further
    while (!rest.empty()) {
      at_.insert(file_.size() - rest.size());
      one(take_record(rest));
    }
    check(at_.count(index_) != 0 || index_ == file_.size(), "has its index elsewhere");
    check(connections_.size() == connections && wanted_chunks_.size() == chunks,
          "has an index of another size");
    for (const std::uint64_t chunk : wanted_chunks_)
      check(chunks_.count(chunk) != 0, "has no chunk where it says");
    for (const std::uint32_t connection : wanted_)
      check(connections_.count(connection) != 0, "names a connection that is not in it");
  }

 private:
  void one(const Record& record) {
    switch (record.op) {
      case kChunk:
        chunk(record);
        chunks_.insert(*at_.rbegin());
        break;
      case kIndex:
        index(record);
        break;
      case kChunkInfo:
        check(record.header.number<std::uint32_t>("ver") == 1, "has an index of another version");
        check(wanted_chunks_.insert(record.header.number<std::uint64_t>("chunk_pos")).second,
              "names a chunk twice");
        record.header.number<std::uint64_t>("start_time");
        record.header.number<std::uint64_t>("end_time");
        check(record.data.size() == std::uint64_t{8} * record.header.number<std::uint32_t>("count"),
              "has an index of another size");
        for (Bytes rest = record.data; !rest.empty(); take(rest, 4))
          wanted_.insert(number_in<std::uint32_t>(take(rest, 4)));
        break;
      case kConnection: {
        const std::uint32_t number = connection(record);
        if (*at_.rbegin() >= index_)  // rosbag knows no others
          check(connections_.insert(number).second, "has a connection twice");
        break;
      }
      default:
        throw Fault{"has a record of an unknown kind"};
    }
  }

  static std::uint32_t connection(const Record& record) {
    record.header.text("topic");
    const Fields described(record.data);
    for (const Bytes name : {"type", "md5sum", "message_definition"}) described.text(name);
    return record.header.number<std::uint32_t>("conn");
  }

  void chunk(const Record& record) {
    const Bytes compression = record.header.text("compression");
    const auto size = record.header.number<std::uint32_t>("size");
    messages_.clear();
    if (compression == "none") {
      check(record.data.size() == size, "has a chunk of another size");
      return inside(record.data);
    }
    check(compression == "bz2" || compression == "lz4", "has a chunk of unknown compression");
    unpacked_ += size;
    check(unpacked_ <= std::max(kAlwaysAllowed, kLargestRatio * file_.size()),
          "has chunks that are far larger than it is");
    inside(unpacked(record.data, compression, size));
  }

  void inside(Bytes chunk) {
    for (Bytes rest = chunk; !rest.empty();) {
      const std::uint64_t at = chunk.size() - rest.size();
      const Record record = take_record(rest);
      check(record.op == kMessage || record.op == kConnection, "has a record of an unknown kind in a chunk");
      if (record.op == kConnection) {
        connection(record);
        continue;
      }
      messages_[at] = record.header.number<std::uint32_t>("conn");
      wanted_.insert(messages_[at]);
      record.header.number<std::uint64_t>("time");
    }
  }

  /// Of the chunk before.
  void index(const Record& record) {
    check(record.header.number<std::uint32_t>("ver") == 1, "has an index of another version");
    const auto connection = record.header.number<std::uint32_t>("conn");
    check(record.data.size() == std::uint64_t{12} * record.header.number<std::uint32_t>("count"),
          "has an index of another size");
    for (Bytes rest = record.data; !rest.empty();) {
      take(rest, 8);  // time
      const auto message = messages_.find(number_in<std::uint32_t>(take(rest, 4)));
      check(message != messages_.end() && message->second == connection,
            "has no message where its index says");
    }
  }

  Bytes file_;
  std::set<std::uint64_t> at_, chunks_, wanted_chunks_;  // positions of records
  std::set<std::uint32_t> connections_, wanted_;
  std::uint64_t index_ = 0, unpacked_ = 0;
  std::map<std::uint64_t, std::uint32_t> messages_;  // of the last chunk: position -> connection
};

/// A file's bytes, mapped.
class MappedFile {
 public:
  explicit MappedFile(const std::string& path) {
    const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);  // a pipe would wait for a writer
    struct stat status {};
    if (file >= 0 && fstat(file, &status) == 0 && S_ISREG(status.st_mode) && status.st_size > 0) {
      size_ = static_cast<std::size_t>(status.st_size);
      data_ = mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, file, 0);
    }
    if (file >= 0) close(file);
    check(data_ != MAP_FAILED, "does not exist, is empty or cannot be read");
  }
  ~MappedFile() { munmap(data_, size_); }
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  Bytes bytes() const { return {static_cast<const char*>(data_), size_}; }

 private:
  void* data_ = MAP_FAILED;
  std::size_t size_ = 0;
};

}  // namespace

void check_bag_structure(const std::string& path) {
  try {
    const MappedFile file(path);
    Walk(file.bytes()).whole();
  } catch (const Fault& fault) {
    throw geometry::Refusal(geometry::refusal::kBrokenFile, fmt::format("{}: {}", path, fault.what));
  }
}

bool is_scan_topic(const std::string& topic) {
  const std::string absolute = "/" + topic, wanted = "/scan/points";
  return absolute.size() >= wanted.size() &&
         absolute.compare(absolute.size() - wanted.size(), wanted.size(), wanted) == 0;
}

}  // namespace tensegric_fit::files
