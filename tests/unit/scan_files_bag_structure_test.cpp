/// Bags made by hand, on which rosbag or roslz4 write or read beyond their buffers, or unpack without end.
#include <gtest/gtest.h>
#include <roslz4/lz4s.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "files/bag_structure.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::files {
namespace {

template <typename Number>
std::string raw(Number number) {
  std::string bytes(sizeof number, '\0');
  std::memcpy(bytes.data(), &number, sizeof number);
  return bytes;
}

std::string block(const std::string& bytes) {
  return raw(static_cast<std::uint32_t>(bytes.size())) + bytes;
}

std::string field(const std::string& name, const std::string& value) {
  return block(name + "=" + value);
}

std::string record(int op, const std::string& fields, const std::string& data) {
  return block(field("op", std::string(1, static_cast<char>(op))) + fields) + block(data);
}

std::string connection(std::uint32_t number) {
  return record(7, field("conn", raw(number)) + field("topic", "/scan/points"),
                field("type", "std_msgs/String") + field("md5sum", std::string(32, '0')) +
                    field("message_definition", ""));
}

std::string chunk(const std::string& compression, std::size_t size, const std::string& data) {
  return record(5, field("compression", compression) + field("size", raw(static_cast<std::uint32_t>(size))),
                data);
}

std::string one_message() {
  return connection(0) +
         record(2, field("conn", raw<std::uint32_t>(0)) + field("time", raw<std::uint64_t>(0)), "");
}

/// Of the connection 0, at that place of the chunk before.
std::string index_of(std::size_t at) {
  return record(4,
                field("ver", raw<std::uint32_t>(1)) + field("conn", raw<std::uint32_t>(0)) +
                    field("count", raw<std::uint32_t>(1)),
                raw<std::uint64_t>(0) + raw(static_cast<std::uint32_t>(at)));
}

struct Counts {
  std::uint32_t connections = 1, infos = 1;
  std::string encryptor;
};

class BagStructure : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }

  /// `chunks`: with what follows each; the index has as much as `counts` says.
  std::string checked(const std::string& chunks, const Counts& counts = {},
                      std::uint32_t said_connections = 1) const {
    const std::string first = "#ROSBAG V2.0\n";
    const auto head = [&](std::uint64_t index) {
      return record(3,
                    field("index_pos", raw(index)) + field("conn_count", raw(said_connections)) +
                        field("chunk_count", raw(counts.infos)) + counts.encryptor,
                    std::string(100, ' '));
    };
    const std::size_t begin = first.size() + head(0).size();
    std::string bytes = first + head(begin + chunks.size()) + chunks;
    for (std::uint32_t i = 0; i < counts.connections; ++i) bytes += connection(i);
    for (std::uint32_t i = 0; i < counts.infos; ++i)
      bytes += record(6,
                      field("ver", raw<std::uint32_t>(1)) + field("chunk_pos", raw<std::uint64_t>(begin)) +
                          field("start_time", raw<std::uint64_t>(0)) +
                          field("end_time", raw<std::uint64_t>(0)) + field("count", raw<std::uint32_t>(1)),
                      raw<std::uint32_t>(0) + raw<std::uint32_t>(1));
    std::ofstream(path_, std::ios::binary) << bytes;
    try {
      check_bag_structure(path_);
    } catch (const geometry::Refusal& refusal) {
      return refusal.what();
    }
    return "accepted";
  }

  static std::string plain() {
    return chunk("none", one_message().size(), one_message()) + index_of(connection(0).size());
  }

  const std::string path_ =
      std::filesystem::temp_directory_path() / ("bag_structure_test." + std::to_string(getpid()));
};

TEST_F(BagStructure, ASoundOneIsAccepted) {
  EXPECT_EQ(checked(plain()), "accepted");
}

TEST_F(BagStructure, ConnectionsThatTheIndexLacksAreRefused) {
  EXPECT_NE(checked(plain(), {0, 1, ""}, 0), "accepted") << "rosbag would use a connection that is not there";
  EXPECT_NE(checked(plain(), {1, 1, ""}, 2), "accepted");
}

TEST_F(BagStructure, AChunkThatIsNamedTwiceIsRefused) {
  EXPECT_NE(checked(plain(), {1, 2, ""}), "accepted");
}

TEST_F(BagStructure, AnEncryptedOneIsRefused) {
  EXPECT_NE(checked(plain(), {1, 1, field("encryptor", "rosbag/AesCbcEncryptor")}), "accepted");
}

TEST_F(BagStructure, AnLz4BlockLargerThanItsBufferIsRefused) {
  std::string data = one_message(), packed(data.size() + 1000, '\0');
  auto size = static_cast<unsigned int>(packed.size());
  ASSERT_EQ(
      roslz4_buffToBuffCompress(data.data(), static_cast<unsigned int>(data.size()), packed.data(), &size, 6),
      ROSLZ4_OK);
  packed.resize(size);
  EXPECT_EQ(checked(chunk("lz4", data.size(), packed) + index_of(connection(0).size())), "accepted");
  const std::string head("\x04\x22\x4D\x18\x64\x40\xA7", 7),
      plain_block = raw(std::uint32_t{0x80000000u | 1048575u});
  EXPECT_NE(checked(chunk("lz4", 1048575,
                          head + plain_block + std::string(1048575, 'A') + raw<std::uint32_t>(0) +
                              raw<std::uint32_t>(0))),
            "accepted");
  EXPECT_NE(checked(chunk("lz4", 10, head.substr(0, 5))), "accepted");
  EXPECT_NE(checked(chunk("lz4", 10, head + raw<std::uint32_t>(0) + raw<std::uint32_t>(0) + "more")),
            "accepted");
}

TEST_F(BagStructure, ChunksFarLargerThanTheFileAreRefused) {
  std::string zeros(64 << 20, '\0'), packed(zeros.size(), '\0');
  auto size = static_cast<unsigned int>(packed.size());
  ASSERT_EQ(roslz4_buffToBuffCompress(zeros.data(), static_cast<unsigned int>(zeros.size()), packed.data(),
                                      &size, 6),
            ROSLZ4_OK);
  packed.resize(size);
  std::string chunks;
  for (int i = 0; i < 6; ++i) chunks += chunk("lz4", zeros.size(), packed);
  EXPECT_NE(checked(chunks), "accepted");
}

TEST_F(BagStructure, APipeIsRefusedWithoutWaiting) {
  ASSERT_EQ(mkfifo(path_.c_str(), 0600), 0);
  EXPECT_THROW(check_bag_structure(path_), geometry::Refusal);
}

}  // namespace
}  // namespace tensegric_fit::files
