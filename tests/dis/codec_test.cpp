#include "dis/codec.h"

#include "tests/dis/fixtures.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

namespace belvedere::dis {
namespace {

void Put(std::vector<uint8_t>& bytes, size_t at, uint64_t value, size_t count) {
  for (size_t i = 0; i < count; ++i) bytes.at(at + i) = static_cast<uint8_t>(value >> (8 * (count - 1 - i)));
}
void PutFloat(std::vector<uint8_t>& bytes, size_t at, float value) {
  Put(bytes, at, std::bit_cast<uint32_t>(value), 4);
}
void PutDouble(std::vector<uint8_t>& bytes, size_t at, double value) {
  Put(bytes, at, std::bit_cast<uint64_t>(value), 8);
}

// A PDU of zeros but for its header.
std::vector<uint8_t> Blank(uint8_t type, size_t length) {
  std::vector<uint8_t> bytes(length);
  bytes[0] = 6;
  bytes[1] = 1;
  bytes[2] = type;
  Put(bytes, 8, length, 2);
  return bytes;
}

Rejection Refusal(const std::vector<uint8_t>& datagram) {
  const std::vector<Pdu> pdus = ReadAll(datagram);
  EXPECT_EQ(pdus.size(), 1u);
  EXPECT_EQ(pdus.at(0).verdict, Verdict::kRejected);
  EXPECT_TRUE(std::holds_alternative<std::monostate>(pdus.at(0).body));
  return pdus.at(0).rejection;
}

TEST(Codec, AnEntityStateComesBackAsItWentOut) {
  const EntityState in = SomeEntity();
  for (const uint8_t version : {uint8_t{5}, uint8_t{6}, uint8_t{7}}) {
    const std::vector<uint8_t> bytes = Encoded(in, {.version = version, .exercise = 9, .timestamp = 0xFFFFFFFF});
    ASSERT_EQ(bytes.size(), kEntityStateBytes);
    const std::vector<Pdu> pdus = ReadAll(bytes);
    ASSERT_EQ(pdus.size(), 1u);
    ASSERT_EQ(pdus[0].verdict, Verdict::kDecoded);
    EXPECT_EQ(pdus[0].header.version, version);
    EXPECT_EQ(pdus[0].header.exercise, 9);
    EXPECT_EQ(pdus[0].header.type, kEntityState);
    EXPECT_EQ(pdus[0].header.timestamp, 0xFFFFFFFF);
    EXPECT_EQ(pdus[0].header.length, kEntityStateBytes);
    const auto& out = std::get<EntityState>(pdus[0].body);
    EXPECT_EQ(out.id, in.id);
    EXPECT_EQ(out.force, in.force);
    EXPECT_EQ(out.type, in.type);
    EXPECT_EQ(out.alternative_type, in.alternative_type);
    EXPECT_EQ(out.velocity_mps, in.velocity_mps);
    EXPECT_EQ(out.position_ecef, in.position_ecef);
    EXPECT_EQ(out.orientation_rad, in.orientation_rad);
    EXPECT_EQ(out.appearance, in.appearance);
    EXPECT_EQ(out.model, in.model);
    EXPECT_EQ(out.acceleration_mps2, in.acceleration_mps2);
    EXPECT_EQ(out.angular_velocity_radps, in.angular_velocity_radps);
    EXPECT_EQ(out.marking, in.marking);
    EXPECT_EQ(out.capabilities, in.capabilities);
    EXPECT_EQ(out.parameters.size(), 0u);
  }
}

TEST(Codec, BytesAreWhereTheStandardPutsThem) {
  const std::vector<uint8_t> bytes = Encoded(SomeEntity(), {.version = 7, .exercise = 3, .timestamp = 0x01020304});
  const std::vector<uint8_t> head(bytes.begin(), bytes.begin() + 28);
  const std::vector<uint8_t> expected = {7,    3,    1, 1, 1, 2, 3, 4, 0, 144,  0,  0, 0, 1,
                                         0x0B, 0xB9, 0, 7, 1, 0, 1, 2, 0, 0xE1, 57, 1, 3, 0};
  EXPECT_EQ(head, expected);
  EXPECT_EQ(bytes[88], 4);
  EXPECT_EQ(bytes[128], 1);
  EXPECT_EQ(bytes[129], 'U');
}

TEST(Codec, ARemoveEntityComesBackAsItWentOut) {
  std::vector<uint8_t> bytes(PduTraits<RemoveEntity>::kFixedBytes);
  ASSERT_EQ(EncodePdu({}, RemoveEntity{{1, 2, 0}, {3, 4, 5}, 99}, bytes), PduTraits<RemoveEntity>::kFixedBytes);
  const std::vector<Pdu> pdus = ReadAll(bytes);
  ASSERT_EQ(pdus.size(), 1u);
  const auto& remove = std::get<RemoveEntity>(pdus[0].body);
  EXPECT_EQ(remove.originating, (EntityId{1, 2, 0}));
  EXPECT_EQ(remove.removed, (EntityId{3, 4, 5}));
  EXPECT_EQ(remove.request, 99u);
}

// Encodes, reads the one PDU back and gives its body; `bytes` keep what it points to.
template <typename Body>
Body ThereAndBack(const Body& body, std::vector<uint8_t>& bytes, size_t expected_bytes) {
  bytes.assign(4096, 0xAA);
  bytes.resize(EncodePdu({.version = 6}, body, bytes));
  EXPECT_EQ(bytes.size(), expected_bytes);
  const std::vector<Pdu> pdus = ReadAll(bytes);
  EXPECT_EQ(pdus.size(), 1u);
  EXPECT_EQ(pdus.at(0).verdict, Verdict::kDecoded) << RejectionText(pdus.at(0).rejection);
  EXPECT_EQ(pdus.at(0).header.family, PduTraits<Body>::kFamily);
  // What is not told apart by a test of a field is told apart by its bytes.
  std::vector<uint8_t> again(bytes.size());
  EXPECT_EQ(EncodePdu(pdus.at(0).header, std::get<Body>(pdus.at(0).body), again), bytes.size());
  EXPECT_EQ(again, bytes);
  return std::get<Body>(pdus.at(0).body);
}

const glm::dvec3 kPlace{-2430000.125, -4440000.5, 3870000.75};

TEST(Codec, EventsOfEntitiesComeBackAsTheyWentOut) {
  std::vector<uint8_t> bytes;
  const EntityStateUpdate update{{1, 2, 3}, {1, 2, 3}, kPlace, {0.1f, 0.2f, 0.3f}, 0x00200000, {}};
  EXPECT_EQ(ThereAndBack(update, bytes, 72).appearance, 0x00200000u);
  const MunitionDescriptor shell{{2, 2, 225, 1, 2, 3, 4}, 1000, 2000, 3, 4};
  const Fire fire{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {1, 2, 10}, 77, kPlace, shell, {1, 2, 3}, 4500.0f};
  EXPECT_EQ(ThereAndBack(fire, bytes, 96).range_m, 4500.0f);
  EXPECT_EQ(bytes[80 - 3], 3);  // quantity
  Detonation detonation{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {1, 2, 10}, {1, 2, 3}, kPlace, shell, {4, 5, 6}, 5, {}};
  EXPECT_EQ(ThereAndBack(detonation, bytes, 104).result, 5);
  const auto part = EncodeParameter({.attached_to = 1, .part_type = 0x100B, .value = 0.5f});
  detonation.parameters.raw = RawBytes(part);
  EXPECT_EQ(ThereAndBack(detonation, bytes, 120).parameters[0].value, 0.5f);
  const Collision collision{{1, 2, 3}, {4, 5, 6}, {1, 2, 10}, 1, {1, 2, 3}, 1500.0f, {0.5f, 0, 0}};
  EXPECT_EQ(ThereAndBack(collision, bytes, 60).mass_kg, 1500.0f);
  EXPECT_EQ(bytes[30], 1);
}

TEST(Codec, SimulationManagementComesBackAsItWentOut) {
  std::vector<uint8_t> bytes;
  EXPECT_EQ(ThereAndBack(CreateEntity{{1, 2, 0}, {3, 4, 5}, 99}, bytes, 28).created, (EntityId{3, 4, 5}));
  const StartResume start{{1, 2, 0}, {3, 4, 5}, {-2, 100}, {5, 200}, 99};
  EXPECT_EQ(ThereAndBack(start, bytes, 44).real_world.hours, -2);
  const StopFreeze stop{{1, 2, 0}, {3, 4, 5}, {480000, 100}, 2, 1, 99};
  EXPECT_EQ(ThereAndBack(stop, bytes, 40).reason, 2);
  EXPECT_EQ(bytes[32], 2);
  EXPECT_EQ(bytes[39], 99);
}

TEST(Codec, RadiosAndBeamsComeBackAsTheyWentOut) {
  std::vector<uint8_t> bytes;
  const Designator designator{{1, 2, 3}, 4, {5, 6, 7}, 8, 9.0f, 1.06f, {1, 2, 3}, kPlace, 2, {4, 5, 6}};
  EXPECT_EQ(ThereAndBack(designator, bytes, 88).spot_ecef, kPlace);
  EXPECT_EQ(bytes[72], 2);
  const std::vector<uint8_t> tail = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  Transmitter transmitter{.id = {1, 2, 3}, .radio = 4, .state = 2, .antenna_ecef = kPlace, .frequency_hz = 243'000'000};
  transmitter.modulation_parameters = RawBytes(std::span(tail).first(4));
  transmitter.antenna_pattern = RawBytes(std::span(tail).last(8));
  const Transmitter heard = ThereAndBack(transmitter, bytes, 116);
  EXPECT_EQ(heard.frequency_hz, 243'000'000u);
  EXPECT_EQ(heard.antenna_pattern.bytes()[0], 5);
  EXPECT_EQ(bytes[71], 8);
  EXPECT_EQ(bytes[100], 4);
  Signal signal{.id = {1, 2, 3}, .radio = 4, .sample_rate_hz = 8000, .data_bits = 20, .samples = 2};
  signal.data = RawBytes(std::span(tail).first(3));
  EXPECT_EQ(ThereAndBack(signal, bytes, 35).data.size(), 3u);
  EnvironmentalProcess process{.id = {1, 2, 3}, .status = 2, .record_count = 1, .sequence = 9};
  process.records = RawBytes(std::span(tail).first(8));
  EXPECT_EQ(ThereAndBack(process, bytes, 40).records.size(), 8u);
  GriddedData grid{.id = {1, 2, 3}, .pdu_total = 4, .axis_count = 2, .sample_time = 1, .value_count = 77};
  grid.grid = RawBytes(tail);
  EXPECT_EQ(ThereAndBack(grid, bytes, 76).value_count, 77u);
}

std::vector<uint8_t> EmissionOf(std::span<const std::pair<EmitterSystem, std::vector<EmitterBeam>>> systems) {
  std::vector<uint8_t> bytes(4096);
  WireWriter wire(bytes);
  for (const auto& [system, beams] : systems) {
    Lay(wire, system);
    for (const EmitterBeam& beam : beams) Lay(wire, beam);
  }
  bytes.resize(wire.at());
  return bytes;
}

TEST(Codec, EmitterSystemsAreReadBeamByBeam) {
  const std::vector<uint8_t> targets(16, 7);
  EmitterBeam tracking{.number = 1, .azimuth_rad = 0.5f, .azimuth_sweep_rad = 0.1f, .target_count = 2};
  tracking.targets = RawBytes(targets);
  const std::vector<std::pair<EmitterSystem, std::vector<EmitterBeam>>> systems = {
      {{.name = 12, .beam_count = 2}, {tracking, {.number = 2}}}, {{.name = 13, .beam_count = 0}, {}}};
  const std::vector<uint8_t> records = EmissionOf(systems);
  EXPECT_EQ(records.size(), 20u + 52 + 16 + 52 + 20);
  ElectromagneticEmission emission{.emitting = {1, 2, 3}, .system_count = 2};
  emission.systems = RawBytes(records);
  std::vector<uint8_t> bytes;
  const ElectromagneticEmission heard = ThereAndBack(emission, bytes, 28 + records.size());
  EmitterReader reader(heard);
  EmitterSystem system;
  EmitterBeam beam;
  ASSERT_TRUE(reader.NextSystem(system));
  EXPECT_EQ(system.name, 12);
  ASSERT_TRUE(reader.NextBeam(beam));
  EXPECT_EQ(beam.azimuth_rad, 0.5f);
  EXPECT_EQ(beam.targets.size(), 16u);
  ASSERT_TRUE(reader.NextSystem(system));  // the second beam is stepped over
  EXPECT_EQ(system.name, 13);
  EXPECT_FALSE(reader.NextSystem(system));
  EXPECT_TRUE(reader.fits());
  emission.system_count = 3;
  bytes.resize(4096);
  bytes.resize(EncodePdu({}, emission, bytes));
  EXPECT_EQ(Refusal(bytes), Rejection::kRecordsDoNotFit);
}

TEST(Codec, WhatAPduAnnouncesMustBeThere) {
  std::vector<uint8_t> transmitter = Blank(kTransmitter, 112);
  Put(transmitter, 70, 9, 2);
  EXPECT_EQ(Refusal(transmitter), Rejection::kRecordsDoNotFit);
  std::vector<uint8_t> signal = Blank(kSignal, 34);
  Put(signal, 28, 17, 2);
  EXPECT_EQ(Refusal(signal), Rejection::kRecordsDoNotFit);
  std::vector<uint8_t> collision = Blank(kCollision, 60);
  PutFloat(collision, 32, std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(Refusal(collision), Rejection::kNotFinite);
}

TEST(Codec, NothingIsWrittenWhereThereIsNoRoom) {
  std::vector<uint8_t> bytes(kEntityStateBytes - 1, 0xAA);
  EXPECT_EQ(EncodePdu({}, SomeEntity(), bytes), 0u);
  EXPECT_EQ(bytes[0], 0xAA);
  EXPECT_EQ(EncodePdu({}, RemoveEntity{}, std::span(bytes).first(27)), 0u);
}

TEST(Codec, VariableParametersAreRead) {
  std::vector<uint8_t> bytes = Encoded(SomeEntity());
  bytes.resize(kEntityStateBytes + 48);
  bytes[19] = 3;
  Put(bytes, 8, bytes.size(), 2);
  Put(bytes, 144, 0x00010002'0000100Bu, 8);  // articulated: change 1, attached to 2, turret azimuth
  PutFloat(bytes, 152, 0.5f);
  Put(bytes, 160, 0x01000000'00000003u, 8);  // attached at station 3
  Put(bytes, 168, 0x02020000'01020304u, 8);
  bytes[176] = 20;
  const std::vector<Pdu> pdus = ReadAll(bytes);
  ASSERT_EQ(pdus.size(), 1u);
  const VariableParameters parameters = std::get<EntityState>(pdus[0].body).parameters;
  ASSERT_EQ(parameters.size(), 3u);
  EXPECT_EQ(parameters[0].change, 1);
  EXPECT_EQ(parameters[0].attached_to, 2);
  EXPECT_EQ(parameters[0].part_type, 0x100Bu);
  EXPECT_EQ(parameters[0].value, 0.5f);
  EXPECT_EQ(parameters[1].record_type, 1);
  EXPECT_EQ(parameters[1].part_type, 3u);
  EXPECT_EQ(parameters[1].attached, (EntityType{2, 2, 0, 1, 2, 3, 4}));
  EXPECT_EQ(parameters[2].record_type, 20);
}

TEST(Codec, AnEntityStateUpdateIsRead) {
  std::vector<uint8_t> bytes = Blank(kEntityStateUpdate, PduTraits<EntityStateUpdate>::kFixedBytes);
  Put(bytes, 12, 0x0001'0002'0003, 6);
  PutFloat(bytes, 20, 4.0f);
  PutDouble(bytes, 32, 6378137.0);
  PutFloat(bytes, 56, 1.5f);
  Put(bytes, 68, 0x00200000, 4);
  const std::vector<Pdu> pdus = ReadAll(bytes);
  ASSERT_EQ(pdus.size(), 1u);
  const auto& update = std::get<EntityStateUpdate>(pdus[0].body);
  EXPECT_EQ(update.id, (EntityId{1, 2, 3}));
  EXPECT_EQ(update.velocity_mps.x, 4.0f);
  EXPECT_EQ(update.position_ecef.x, 6378137.0);
  EXPECT_EQ(update.orientation_rad.x, 1.5f);
  EXPECT_EQ(update.appearance, kAppearanceFrozen);
}

TEST(Codec, FireAndDetonationAreRead) {
  std::vector<uint8_t> bytes = Blank(kFire, PduTraits<Fire>::kFixedBytes);
  Put(bytes, 12, 0x0001'0002'0003, 6);
  Put(bytes, 18, 0x0004'0005'0006, 6);
  Put(bytes, 36, 77, 4);
  PutDouble(bytes, 40, -1.0);
  Put(bytes, 72, 0x03E8'07D0'0002'0001, 8);
  PutFloat(bytes, 92, 1234.0f);
  const std::vector<Pdu> fires = ReadAll(bytes);
  const auto& fire = std::get<Fire>(fires.at(0).body);
  EXPECT_EQ(fire.target, (EntityId{4, 5, 6}));
  EXPECT_EQ(fire.mission, 77u);
  EXPECT_EQ(fire.position_ecef.x, -1.0);
  EXPECT_EQ(fire.descriptor.warhead, 1000);
  EXPECT_EQ(fire.descriptor.fuse, 2000);
  EXPECT_EQ(fire.range_m, 1234.0f);

  bytes = Blank(kDetonation, PduTraits<Detonation>::kFixedBytes);
  Put(bytes, 24, 0x0007'0008'0009, 6);
  PutDouble(bytes, 64, 5.0);
  PutFloat(bytes, 96, 2.0f);
  bytes[100] = 1;
  const std::vector<Pdu> detonations = ReadAll(bytes);
  const auto& detonation = std::get<Detonation>(detonations.at(0).body);
  EXPECT_EQ(detonation.munition, (EntityId{7, 8, 9}));
  EXPECT_EQ(detonation.position_ecef.z, 5.0);
  EXPECT_EQ(detonation.position_in_target_m.z, 2.0f);
  EXPECT_EQ(detonation.result, 1);
}

TEST(Codec, LengthsAreCheckedBeforeAnythingIsRead) {
  EXPECT_EQ(Refusal({}), Rejection::kShortHeader);
  EXPECT_EQ(Refusal(std::vector<uint8_t>(11, 7)), Rejection::kShortHeader);
  EXPECT_EQ(Refusal(Blank(kEntityState, 12)), Rejection::kShortBody);
  std::vector<uint8_t> bytes = Encoded(SomeEntity());
  for (size_t length = 12; length < kEntityStateBytes; ++length) {
    EXPECT_EQ(Refusal(std::vector<uint8_t>(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length))),
              Rejection::kLengthOverDatagram);
  }
  Put(bytes, 8, 11, 2);
  EXPECT_EQ(Refusal(bytes), Rejection::kLengthUnderHeader);
  bytes = Encoded(SomeEntity());
  bytes[19] = 1;
  EXPECT_EQ(Refusal(bytes), Rejection::kRecordsDoNotFit);
}

TEST(Codec, ValuesThatNobodyCouldUseAreRefused) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::vector<uint8_t> good = Encoded(SomeEntity());
  for (const double value : {kInfinity, -kInfinity, static_cast<double>(NAN), 1e308}) {
    for (const size_t at : {48u, 56u, 64u}) {
      std::vector<uint8_t> bytes = good;
      PutDouble(bytes, at, value);
      EXPECT_EQ(Refusal(bytes), std::isfinite(value) ? Rejection::kPositionOutOfRange : Rejection::kNotFinite);
    }
  }
  for (const size_t at : {36u, 44u, 72u, 80u, 104u, 116u}) {
    std::vector<uint8_t> bytes = good;
    PutFloat(bytes, at, NAN);
    EXPECT_EQ(Refusal(bytes), Rejection::kNotFinite) << at;
  }
  for (const uint64_t id : {0x0000'0000'0000ull, 0x0001'0001'0000ull, 0x0001'0001'FFFEull, 0x0001'0001'FFFFull}) {
    std::vector<uint8_t> bytes = good;
    Put(bytes, 12, id, 6);
    EXPECT_EQ(Refusal(bytes), Rejection::kBadEntityId) << id;
  }
}

TEST(Codec, WhatTheModelDoesNotUseMayBeAnything) {
  EntityState state = SomeEntity();
  state.model = 2;
  state.acceleration_mps2.x = NAN;
  state.angular_velocity_radps.y = INFINITY;
  const std::vector<uint8_t> bytes = Encoded(state);
  const std::vector<Pdu> pdus = ReadAll(bytes);
  ASSERT_EQ(pdus.at(0).verdict, Verdict::kDecoded);
  EXPECT_EQ(std::get<EntityState>(pdus[0].body).acceleration_mps2, glm::vec3(0.0f));
  EXPECT_EQ(std::get<EntityState>(pdus[0].body).angular_velocity_radps, glm::vec3(0.0f));
}

TEST(Codec, OtherTypesAndVersionsAreSteppedOver) {
  std::vector<uint8_t> bundle = Blank(72, 40);
  const std::vector<uint8_t> state = Encoded(SomeEntity());
  bundle.insert(bundle.end(), state.begin(), state.end());
  const std::vector<uint8_t> old = Encoded(SomeEntity(), {.version = 4});
  bundle.insert(bundle.end(), old.begin(), old.end());
  bundle.insert(bundle.end(), state.begin(), state.end());
  const std::vector<Pdu> pdus = ReadAll(bundle);
  ASSERT_EQ(pdus.size(), 4u);
  EXPECT_EQ(pdus[0].verdict, Verdict::kIgnoredType);
  EXPECT_EQ(pdus[1].verdict, Verdict::kDecoded);
  EXPECT_EQ(pdus[1].offset, 40u);
  EXPECT_EQ(pdus[2].verdict, Verdict::kIgnoredVersion);
  EXPECT_EQ(pdus[3].verdict, Verdict::kDecoded);
  EXPECT_EQ(pdus[3].offset, 40u + 2 * kEntityStateBytes);
}

TEST(Codec, PaddingBehindTheLastPduIsNoError) {
  std::vector<uint8_t> bytes = Encoded(SomeEntity());
  bytes.insert(bytes.end(), 4, 0xAA);
  EXPECT_EQ(ReadAll(bytes).size(), 1u);
  bytes = Encoded(SomeEntity());
  bytes.resize(bytes.size() + 100);
  EXPECT_EQ(ReadAll(bytes).size(), 1u);
  bytes.back() = 1;
  const std::vector<Pdu> pdus = ReadAll(bytes);
  ASSERT_EQ(pdus.size(), 2u);
  EXPECT_EQ(pdus[1].rejection, Rejection::kLengthUnderHeader);
}

TEST(Codec, ABadBodyDoesNotSpoilTheRestOfABundle) {
  std::vector<uint8_t> bundle = Encoded(SomeEntity());
  PutFloat(bundle, 36, NAN);
  const std::vector<uint8_t> good = Encoded(SomeEntity(8));
  bundle.insert(bundle.end(), good.begin(), good.end());
  const std::vector<Pdu> pdus = ReadAll(bundle);
  ASSERT_EQ(pdus.size(), 2u);
  EXPECT_EQ(pdus[0].verdict, Verdict::kRejected);
  EXPECT_EQ(pdus[1].verdict, Verdict::kDecoded);
}

// Random edits of good datagrams, each in a block of exactly its size so that a sanitizer sees any step outside.
TEST(Codec, NoEditOfADatagramMakesItReadOutside) {
  std::mt19937 random(42);
  std::vector<std::vector<uint8_t>> seeds = {Encoded(SomeEntity()), Blank(kFire, PduTraits<Fire>::kFixedBytes),
                                             Blank(kDetonation, PduTraits<Detonation>::kFixedBytes + 32),
                                             Blank(kEntityStateUpdate, PduTraits<EntityStateUpdate>::kFixedBytes + 16),
                                             Blank(kRemoveEntity, PduTraits<RemoveEntity>::kFixedBytes)};
  std::vector<uint8_t> bundle;
  for (const auto& seed : seeds) bundle.insert(bundle.end(), seed.begin(), seed.end());
  seeds.push_back(bundle);
  size_t decoded = 0, rejected = 0;
  for (int i = 0; i < 200000; ++i) {
    const std::vector<uint8_t>& seed = seeds[random() % seeds.size()];
    std::vector<uint8_t> bytes(seed.begin(),
                               seed.end() - static_cast<std::ptrdiff_t>(random() % 3 ? 0 : random() % 20));
    for (auto edits = random() % 6; edits > 0; --edits) {
      bytes[random() % std::min<size_t>(bytes.size(), random() % 2 ? 24 : bytes.size())] =
          random() % 2 ? static_cast<uint8_t>(random()) : uint8_t{0xFF};
    }
    size_t end = 0;
    for (const Pdu& pdu : ReadAll(bytes)) {
      ASSERT_GE(pdu.offset, end);
      ASSERT_LE(pdu.offset, bytes.size());
      ASSERT_EQ(pdu.verdict == Verdict::kRejected, pdu.rejection != Rejection::kNone);
      if (const auto* state = std::get_if<EntityState>(&pdu.body)) {
        ASSERT_TRUE(std::isfinite(state->position_ecef.x + state->velocity_mps.x + state->orientation_rad.x));
        for (size_t k = 0; k < state->parameters.size(); ++k)
          ASSERT_EQ(state->parameters[k].record_type, bytes[pdu.offset + 144 + 16 * k]);
      }
      ++(pdu.verdict == Verdict::kRejected ? rejected : decoded);
      end = pdu.offset + (pdu.verdict == Verdict::kRejected ? 0 : pdu.header.length);
    }
  }
  EXPECT_GT(decoded, 10000u);
  EXPECT_GT(rejected, 10000u);
}

}  // namespace
}  // namespace belvedere::dis
