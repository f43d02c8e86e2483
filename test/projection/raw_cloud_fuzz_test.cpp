#include "lidar_panoptic_clustering/projection/raw_cloud.h"

#include "raw_message.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>

namespace lidar_panoptic_clustering
{
namespace
{
/// A valid message of random shape and layout, and the numbers its points were given.
struct RandomMessage
{
  RawMessage message{0, 0, {}, 1};
  std::vector<double> x, label;
};

RandomMessage randomMessage(std::mt19937& random)
{
  const auto upTo = [&](std::uint32_t n) { return std::uniform_int_distribution<std::uint32_t>(0, n)(random); };
  std::vector<std::string> names = {"x", "y", "z", "label"};
  if (upTo(1) != 0) names.emplace_back("intensity");
  if (upTo(1) != 0) names.emplace_back("ring");
  std::shuffle(names.begin(), names.end(), random);

  std::vector<RawField> fields;
  std::uint32_t end = 0;
  for (const auto& name : names)
  {
    const auto type = static_cast<NumberType>(1 + upTo(7));
    const auto count = 1 + (upTo(3) == 0 ? upTo(3) : 0);
    end += upTo(3);
    fields.push_back(rawField(name, end, type, count));
    end += bytesOf(type) * count;
  }
  std::shuffle(fields.begin(), fields.end(), random);

  RandomMessage result;
  result.message = RawMessage(upTo(6), upTo(20), fields, end + upTo(5), upTo(9));
  auto& message = result.message;
  for (std::size_t r = 0; r < message.header.height; ++r)
    for (std::size_t c = 0; c < message.header.width; ++c)
      for (const auto& name : names)
      {
        const double value = upTo(127);
        message.set(r, c, name, value);
        if (name == "x") result.x.push_back(value);
        if (name == "label") result.label.push_back(value);
      }
  return result;
}

/// Readable by every order of rows; exact heap copies of the data let the address sanitizer see any byte too far.
LabelledCloud readExact(const RawMessage& message, RowOrder order)
{
  const std::unique_ptr<std::uint8_t[]> exact(new std::uint8_t[message.bytes.size()]);
  std::copy(message.bytes.begin(), message.bytes.end(), exact.get());
  RawCloud raw = message.view();
  raw.data = exact.get();
  LabelledCloud cloud;
  readLabelled(raw, LabelledFields(), cloud, order);
  return cloud;
}

TEST(RawCloudFuzz, ValidLayoutsAreReadRight)
{
  std::mt19937 random(1);
  for (int i = 0; i < 3000; ++i)
  {
    const auto random_message = randomMessage(random);
    const auto& header = random_message.message.header;
    const auto sent = readExact(random_message.message, RowOrder::kAsSent);
    const auto turned = readExact(random_message.message, RowOrder::kTransposed);
    ASSERT_EQ(sent.points.size(), random_message.x.size());
    ASSERT_EQ(turned.points.size(), random_message.x.size());
    for (std::size_t r = 0; r < header.height; ++r)
      for (std::size_t c = 0; c < header.width; ++c)
      {
        const std::size_t k = r * header.width + c;
        ASSERT_EQ(sent.points[k].x, static_cast<float>(random_message.x[k])) << "case " << i;
        ASSERT_EQ(sent.points[k].label, static_cast<std::uint32_t>(random_message.label[k])) << "case " << i;
        ASSERT_EQ(turned.points[c * header.height + r].x, sent.points[k].x) << "case " << i;
        ASSERT_EQ(turned.points[c * header.height + r].label, sent.points[k].label) << "case " << i;
      }
  }
}

/// Numbers at which sizes wrap, and small ones.
std::uint32_t wildNumber(std::mt19937& random)
{
  static const std::uint32_t kEdges[] = {0,          1,          2,          3,          255,        65535,
                                         0x10000000, 0x20000000, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFE, 0xFFFFFFFF};
  const auto pick = std::uniform_int_distribution<unsigned>(0, 23)(random);
  return pick < 12 ? kEdges[pick] : std::uniform_int_distribution<std::uint32_t>(0, 64)(random);
}

void damage(RawMessage& message, std::mt19937& random)
{
  RawCloud& h = message.header;
  RawField& field = h.fields[random() % h.fields.size()];
  switch (random() % 10)
  {
    case 0:
      h.width = wildNumber(random);
      break;
    case 1:
      h.height = wildNumber(random);
      break;
    case 2:
      h.point_step = wildNumber(random);
      break;
    case 3:
      h.row_step = wildNumber(random);
      break;
    case 4:
      field.offset = wildNumber(random);
      break;
    case 5:
      field.count = wildNumber(random);
      break;
    case 6:
      field.datatype = static_cast<std::uint8_t>(random());
      break;
    case 7:
      field.name = h.fields[random() % h.fields.size()].name;
      break;
    case 8:
      message.bytes.resize(random() % (message.bytes.size() + 8));
      break;
    default:  // any bits for numbers: NaN, infinity, denormals
      for (auto& byte : message.bytes) byte = static_cast<std::uint8_t>(random());
  }
}

TEST(RawCloudFuzz, DamagedMessagesAreReadInsideTheirDataOrRefused)
{
  std::mt19937 random(2);
  int refused = 0, accepted = 0;
  for (int i = 0; i < 20000; ++i)
  {
    auto message = randomMessage(random).message;
    for (auto n = 1 + random() % 3; n > 0; --n) damage(message, random);
    const auto order = random() % 2 == 0 ? RowOrder::kAsSent : RowOrder::kTransposed;
    LabelledCloud cloud;
    const std::string error = errorOf([&] { cloud = readExact(message, order); });
    ++(error.empty() ? accepted : refused);
    if (!error.empty())
    {
      ASSERT_NE(error.find("expected "), std::string::npos) << error;
      ASSERT_NE(error.find(", found "), std::string::npos) << error;
      continue;
    }
    // whatever was accepted has its last byte inside the data
    const RawCloud raw = message.view();
    ASSERT_EQ(cloud.points.size(), std::size_t{raw.width} * raw.height);
    if (cloud.points.empty()) continue;
    for (const char* name : {"x", "y", "z", "label"})
    {
      const RawField* field = findField(raw, name);
      ASSERT_NE(field, nullptr);
      const std::size_t last = std::size_t{raw.height - 1} * raw.row_step + std::size_t{raw.width - 1} * raw.point_step;
      ASSERT_LE(last + field->offset + bytesOf(field->type()), raw.data_size);
    }
  }
  EXPECT_GT(refused, 1000);
  EXPECT_GT(accepted, 1000);
}
}  // namespace
}  // namespace lidar_panoptic_clustering
