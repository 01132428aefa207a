#include "runtime/paging/vector_codec.h"

#include "runtime/paging/page_envelope.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>
#include <utility>

namespace belvedere {
namespace {

constexpr uint8_t kKindVector = 5;
constexpr uint8_t kKindBuildings = 6;
constexpr int kZstdLevel = 6;
constexpr uint32_t kMostRawBytes = 64u << 20;
constexpr double kCentimetre = 0.01;
constexpr int64_t kFurthest = int64_t{1} << 40;  // centimetres: more is none on the Earth

class Writer {
 public:
  void Byte(uint8_t value) { bytes_.push_back(value); }
  // 7 bits a byte, the lowest first; the top bit says that more follow.
  void Number(uint64_t value) {
    for (; value >= 0x80; value >>= 7) Byte(static_cast<uint8_t>(value | 0x80));
    Byte(static_cast<uint8_t>(value));
  }
  void Signed(int64_t value) { Number((static_cast<uint64_t>(value) << 1) ^ static_cast<uint64_t>(value >> 63)); }
  void Text(const std::string& text) {
    Number(text.size());
    bytes_.insert(bytes_.end(), text.begin(), text.end());
  }
  void Double(double value) {
    const auto bits = std::bit_cast<uint64_t>(value);
    for (int byte = 0; byte < 8; ++byte) Byte(static_cast<uint8_t>(bits >> (8 * byte)));
  }
  const std::vector<uint8_t>& bytes() const { return bytes_; }

 private:
  std::vector<uint8_t> bytes_;
};

// Reads past the end, and numbers that are too large, give 0 and are remembered.
class Reader {
 public:
  explicit Reader(std::span<const uint8_t> bytes) : bytes_(bytes) {}

  bool ok() const { return ok_; }
  bool at_end() const { return at_ == bytes_.size(); }
  uint8_t Byte() {
    if (at_ < bytes_.size()) return bytes_[at_++];
    ok_ = false;
    return 0;
  }
  uint64_t Number() {
    uint64_t value = 0;
    for (int shift = 0; shift < 64; shift += 7) {
      const uint8_t byte = Byte();
      value |= static_cast<uint64_t>(byte & 0x7F) << shift;
      if ((byte & 0x80) == 0) return value;
    }
    ok_ = false;
    return 0;
  }
  int64_t Signed() {
    const uint64_t value = Number();
    return static_cast<int64_t>(value >> 1) ^ -static_cast<int64_t>(value & 1);
  }
  // The sum of what was before and what comes, which lies between the two.
  int64_t After(int64_t before, int64_t least, int64_t most) {
    int64_t sum = 0;
    const bool is_good = !__builtin_add_overflow(before, Signed(), &sum) && sum >= least && sum <= most;
    ok_ = ok_ && is_good;
    return ok_ ? sum : least;
  }
  uint32_t AtMost(uint64_t most) {
    const uint64_t value = Number();
    ok_ = ok_ && value <= most;
    return ok_ ? static_cast<uint32_t>(value) : 0;
  }
  // A place among so many.
  uint32_t Place(size_t size) {
    ok_ = ok_ && size > 0;
    return ok_ ? AtMost(size - 1) : 0;
  }
  // Of things that take a byte at least each.
  uint32_t Count() {
    const uint64_t count = Number();
    ok_ = ok_ && count <= bytes_.size() - at_;
    return ok_ ? static_cast<uint32_t>(count) : 0;
  }
  std::string Text() {
    const uint32_t size = Count();
    const auto text = bytes_.subspan(at_, size);
    at_ += size;
    return {text.begin(), text.end()};
  }
  double Double() {
    uint64_t bits = 0;
    for (int byte = 0; byte < 8; ++byte) bits |= static_cast<uint64_t>(Byte()) << (8 * byte);
    return std::bit_cast<double>(bits);
  }

 private:
  std::span<const uint8_t> bytes_;
  size_t at_ = 0;
  bool ok_ = true;
};

void PutValue(Writer& out, const AttributeValue& value) {
  out.Byte(static_cast<uint8_t>(value.index()));
  if (const auto* number = std::get_if<int64_t>(&value)) out.Signed(*number);
  if (const auto* real = std::get_if<double>(&value)) out.Double(*real);
  if (const auto* text = std::get_if<std::string>(&value)) out.Text(*text);
}

AttributeValue GetValue(Reader& in) {
  const uint32_t type = in.AtMost(2);
  if (type == 0) return in.Signed();
  if (type == 1) return in.Double();
  return in.Text();
}

// Whether the sum of what is read stays within `total`: `sum` is advanced by it.
uint32_t Share(Reader& in, uint32_t& sum, size_t total) {
  const uint32_t share = in.AtMost(total - sum);
  sum += share;
  return share;
}

// How many there are in each list; and room for as many.
template <typename... Lists>
void PutCounts(Writer& out, const Lists&... lists) {
  (out.Number(lists.size()), ...);
}
template <typename... Lists>
void GetCounts(Reader& in, Lists&... lists) {
  (lists.resize(in.Count()), ...);
}

Result<std::span<const uint8_t>> Unwrap(std::span<const uint8_t> bytes, uint8_t kind) {
  if (Status status = CheckPageHeader(bytes, kind); !status.ok()) return status;
  const uint32_t raw_bytes = RawBytesOf(bytes);
  if (raw_bytes > kMostRawBytes)
    return Status::Error("a page of {} bytes, more than the {} it may have", raw_bytes, kMostRawBytes);
  return UnwrapPage(bytes, raw_bytes);
}

int64_t Centimetres(float metres) {
  return std::llround(static_cast<double>(metres) / kCentimetre);
}
float Metres(int64_t centimetres) {
  return static_cast<float>(static_cast<double>(centimetres) * kCentimetre);
}

}  // namespace

std::vector<uint8_t> EncodeVector(const VectorPage& page) {
  Writer out;
  out.Byte(page.is_complete ? 1 : 0);
  PutCounts(out, page.features, page.parts, page.points, page.attributes, page.keys, page.values);
  int64_t id = 0;
  for (const VectorFeature& feature : page.features) {
    out.Signed(static_cast<int64_t>(feature.id) - std::exchange(id, feature.id));
    out.Byte(static_cast<uint8_t>(feature.of));
    out.Byte(static_cast<uint8_t>(feature.shape));
    out.Number(feature.parts);
    out.Number(feature.attributes);
  }
  for (const VectorPage::Part& part : page.parts) out.Number(part.points);
  VectorPoint last;
  for (const VectorPoint& point : page.points) {
    out.Signed(int64_t{point.x} - last.x);
    out.Signed(int64_t{point.y} - last.y);
    last = point;
  }
  for (const VectorPage::AttributeUse& use : page.attributes) {
    out.Number(use.key);
    out.Number(use.value);
  }
  for (const std::string& key : page.keys) out.Text(key);
  for (const AttributeValue& value : page.values) PutValue(out, value);
  return WrapPage(kKindVector, 0, out.bytes(), kZstdLevel);
}

Result<std::shared_ptr<VectorPage>> DecodeVector(std::span<const uint8_t> bytes) {
  const auto raw = Unwrap(bytes, kKindVector);
  if (!raw.ok()) return raw.status();
  Reader in(*raw);
  auto page = std::make_shared<VectorPage>();
  page->is_complete = in.AtMost(1) == 1;
  GetCounts(in, page->features, page->parts, page->points, page->attributes, page->keys, page->values);
  int64_t id = 0;
  uint32_t parts = 0, attributes = 0, points = 0;
  for (VectorFeature& feature : page->features) {
    id = in.After(id, 0, UINT32_MAX);
    feature.id = static_cast<uint32_t>(id);
    feature.of = static_cast<FeatureClass>(in.AtMost(kFeatureClasses - 1));
    feature.shape = static_cast<FeatureShape>(in.AtMost(2));
    feature.first_part = parts;
    feature.parts = Share(in, parts, page->parts.size());
    feature.first_attribute = attributes;
    feature.attributes = Share(in, attributes, page->attributes.size());
  }
  for (VectorPage::Part& part : page->parts) {
    part.first_point = points;
    part.points = Share(in, points, page->points.size());
  }
  int64_t x = 0, y = 0;
  for (VectorPoint& point : page->points) {
    x = in.After(x, INT32_MIN, INT32_MAX);
    y = in.After(y, INT32_MIN, INT32_MAX);
    point = {static_cast<int32_t>(x), static_cast<int32_t>(y)};
  }
  for (VectorPage::AttributeUse& use : page->attributes) {
    use.key = in.Place(page->keys.size());
    use.value = in.Place(page->values.size());
  }
  for (std::string& key : page->keys) key = in.Text();
  for (AttributeValue& value : page->values) value = GetValue(in);
  const bool is_whole = parts == page->parts.size() && attributes == page->attributes.size() &&
                        points == page->points.size() && in.at_end();
  if (!in.ok() || !is_whole) return Status::Error("features that do not fit their page");
  return page;
}

std::vector<uint8_t> EncodeBuildings(const BuildingPage& page) {
  Writer out;
  PutCounts(out, page.buildings, page.vertices, page.indices, page.details);
  int64_t id = 0;
  for (const Building& building : page.buildings) {
    out.Signed(static_cast<int64_t>(building.feature) - std::exchange(id, building.feature));
    out.Number(building.anchor.x);
    out.Number(building.anchor.y);
    out.Signed(Centimetres(building.height_m));
    out.Signed(Centimetres(building.radius_m));
  }
  std::array<int64_t, 3> last{};
  for (const BuildingVertex& vertex : page.vertices) {
    out.Number(vertex.building);
    size_t axis = 0;
    for (const float length_m : {vertex.east_m, vertex.north_m, vertex.up_m}) {
      const int64_t length = Centimetres(length_m);
      out.Signed(length - std::exchange(last[axis++], length));
    }
    for (const int8_t part : vertex.normal) out.Byte(static_cast<uint8_t>(part));
    for (const uint8_t part : vertex.colour) out.Byte(part);
  }
  int64_t index = 0;
  for (const uint32_t next : page.indices) out.Signed(int64_t{next} - std::exchange(index, next));
  for (const BuildingPage::Detail& detail : page.details) {
    out.Number(detail.indices);
    out.Signed(Centimetres(detail.error_m));
  }
  return WrapPage(kKindBuildings, 0, out.bytes(), kZstdLevel);
}

Result<std::shared_ptr<BuildingPage>> DecodeBuildings(std::span<const uint8_t> bytes) {
  const auto raw = Unwrap(bytes, kKindBuildings);
  if (!raw.ok()) return raw.status();
  Reader in(*raw);
  auto page = std::make_shared<BuildingPage>();
  GetCounts(in, page->buildings, page->vertices, page->indices, page->details);
  int64_t id = 0;
  for (Building& building : page->buildings) {
    id = in.After(id, 0, UINT32_MAX);
    building.feature = static_cast<uint32_t>(id);
    building.anchor.x = in.AtMost(UINT32_MAX);
    building.anchor.y = in.AtMost(kGridNorthPole);
    building.height_m = Metres(in.Signed());
    building.radius_m = Metres(in.Signed());
  }
  std::array<int64_t, 3> place{};
  for (BuildingVertex& vertex : page->vertices) {
    vertex.building = static_cast<uint16_t>(in.Place(page->buildings.size()));
    for (int64_t& axis : place) axis = in.After(axis, -kFurthest, kFurthest);
    vertex.east_m = Metres(place[0]);
    vertex.north_m = Metres(place[1]);
    vertex.up_m = Metres(place[2]);
    for (int8_t& part : vertex.normal) part = static_cast<int8_t>(in.Byte());
    for (uint8_t& part : vertex.colour) part = in.Byte();
  }
  int64_t index = 0;
  bool is_whole = in.ok() && page->buildings.size() <= UINT16_MAX + size_t{1};
  for (uint32_t& next : page->indices) {
    index = in.After(index, 0, static_cast<int64_t>(page->vertices.size()) - 1);
    next = static_cast<uint32_t>(index);
  }
  uint32_t indices = 0;
  for (BuildingPage::Detail& detail : page->details) {
    detail.first_index = indices;
    detail.indices = Share(in, indices, page->indices.size());
    detail.error_m = Metres(in.Signed());
    is_whole = is_whole && detail.indices % 3 == 0;
  }
  if (!in.ok() || !is_whole || indices != page->indices.size() || !in.at_end())
    return Status::Error("buildings that do not fit their page");
  return page;
}

}  // namespace belvedere
