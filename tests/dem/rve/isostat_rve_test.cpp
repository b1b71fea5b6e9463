// SPDX-License-Identifier: BSD-3-Clause
// The C interface: the numbers of the C++ class, and a status with a message for every mistake.
#include "dem/rve/isostat_rve.h"

#include "dem/io/specimen_file.hpp"
#include "dem/io/specimen_library.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/rve_paths.hpp"
#include "tests/support/temporary_folder.hpp"

#include <limits>
#include <thread>

namespace isostat
{
namespace
{
constexpr double shear[9] = {0, 1e-4, 0, 0, 0, 0, 0, 0, 0};
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

RveSettings usual() { return {.motion = controlled_motion()}; }

void expect_error(isostat_status actual, isostat_status expected, const std::vector<std::string> &parts)
{
  EXPECT_EQ(actual, expected);
  test::expect_parts(isostat_rve_error(), parts);
}

/// Elements of a specimen file of 300 grains, destroyed at the end.
class IsostatRve : public TemporaryFolder
{
protected:
  IsostatRve() { write_specimen(path, {test::rve_specimen(), {}, {}}); }
  ~IsostatRve() override
  {
    for (isostat_rve *rve : made)
      isostat_rve_destroy(rve);
  }

  isostat_rve *keep(isostat_rve *rve) { return made.emplace_back(rve); }
  isostat_rve *create(const isostat_rve_settings *settings = nullptr, const std::string &place = "")
  {
    isostat_rve *rve = nullptr;
    EXPECT_EQ(isostat_rve_create(place.empty() ? path.c_str() : place.c_str(), settings, &rve), ISOSTAT_OK)
        << isostat_rve_error();
    return keep(rve);
  }
  static std::vector<double> stress(const isostat_rve *rve)
  {
    std::vector<double> numbers(6);
    EXPECT_EQ(isostat_rve_stress(rve, numbers.data()), ISOSTAT_OK);
    return numbers;
  }
  static std::vector<std::byte> pack(const isostat_rve *rve)
  {
    std::size_t size = 0;
    EXPECT_EQ(isostat_rve_pack(rve, nullptr, &size), ISOSTAT_OK);
    std::vector<std::byte> bytes(size);
    EXPECT_EQ(isostat_rve_pack(rve, bytes.data(), &size), ISOSTAT_OK);
    return bytes;
  }
  /// The element's bytes without what it has cost, which rejected and undone increments add to.
  static RveState state(const isostat_rve *rve) { return Rve::unpack(pack(rve), usual()).save(); }

  std::filesystem::path path = folder / "sand.h5";
  std::vector<isostat_rve *> made;
};

std::vector<double> voigt(const Mat3 &s) { return {s(0, 0), s(1, 1), s(2, 2), s(1, 2), s(0, 2), s(0, 1)}; }

Mat3 path_gradient(int k) { return 5 * test::increment(k); }

std::vector<double> rows(const Mat3 &m)
{
  const Mat3 t = m.transpose();
  return {t.data(), t.data() + 9};
}
} // namespace

TEST_F(IsostatRve, NumbersAreThoseOfTheClassBitForBit)
{
  Rve direct(test::rve_specimen(), usual());
  isostat_rve *rve = create();
  isostat_rve_response response;
  EXPECT_EQ(stress(rve), voigt(direct.stress()));
  for (int k = 0; k < 4; ++k)
    {
      const Mat3 h = path_gradient(k);
      const RveResponse expected = k % 2 ? direct.advance(h) : direct.undrained(h);
      ASSERT_EQ((k % 2 ? isostat_rve_advance : isostat_rve_undrained)(rve, rows(h).data(), &response), ISOSTAT_OK);
      EXPECT_EQ(std::vector(response.stress, response.stress + 6), voigt(expected.stress));
      EXPECT_EQ(response.mean_stress_change, expected.mean_stress_change);
      EXPECT_EQ(response.indicator, expected.indicator);
      EXPECT_EQ(response.steps, expected.steps);
    }
  test::expect_same_bits(state(rve), direct.save());
  double e, dry, saturated, stiffness[36];
  uint64_t steps;
  ASSERT_EQ(isostat_rve_void_ratio(rve, &e), ISOSTAT_OK);
  ASSERT_EQ(isostat_rve_densities(rve, 999, &dry, &saturated), ISOSTAT_OK);
  ASSERT_EQ(isostat_rve_densities(rve, 999, nullptr, nullptr), ISOSTAT_OK);
  ASSERT_EQ(isostat_rve_steps(rve, &steps), ISOSTAT_OK);
  EXPECT_EQ(e, direct.void_ratio());
  EXPECT_EQ(dry, direct.dry_density());
  EXPECT_EQ(saturated, direct.saturated_density(999));
  EXPECT_EQ(steps, direct.cost().steps);
  for (const bool elastic : {true, false})
    {
      ASSERT_EQ(isostat_rve_stiffness(rve, elastic, stiffness), ISOSTAT_OK);
      const Mat6 expected = direct.stiffness(elastic ? Sliding::elastic : Sliding::plastic).transpose();
      EXPECT_TRUE(std::equal(stiffness, stiffness + 36, expected.data()));
    }
}

TEST_F(IsostatRve, MixedControlKeepsTheStressesThatAreNamed)
{
  Rve direct(test::rve_specimen(), usual());
  isostat_rve *rve = create();
  MixedIncrement drained{.gradient = test::simple_shear(1e-4), .stress = direct.stress()};
  drained.controlled.diagonal().setConstant(true);
  drained.controlled(1, 2) = drained.controlled(2, 1) = true;
  const int controlled[6] = {1, 1, 1, 1, 0, 0};
  std::vector<double> target = stress(rve);
  target[4] = not_a_number; // not used
  ASSERT_EQ(isostat_rve_mixed(rve, shear, target.data(), controlled, 1e-3, nullptr), ISOSTAT_OK) << isostat_rve_error();
  ASSERT_EQ(direct.advance(drained).outcome, RveOutcome::accepted);
  test::expect_same_bits(state(rve), direct.save());
}

TEST_F(IsostatRve, SettingsReachTheElement)
{
  isostat_rve_settings settings;
  isostat_rve_default_settings(&settings);
  settings.inertial_number = 1e-3;
  settings.damping = 0.3;
  settings.min_steps = 70;
  const double about_z[9] = {0, -1, 0, 1, 0, 0, 0, 0, 1};
  std::copy(about_z, about_z + 9, settings.frame);
  RveSettings same{.motion = controlled_motion(), .min_steps = 70};
  same.motion.inertial_number = 1e-3;
  same.motion.damping = 0.3;
  same.frame << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  Rve direct(test::rve_specimen(), same);
  isostat_rve *rve = create(&settings);
  isostat_rve_response response;
  ASSERT_EQ(isostat_rve_advance(rve, shear, &response), ISOSTAT_OK);
  const RveResponse expected = direct.advance(test::simple_shear(1e-4));
  EXPECT_EQ(response.steps, expected.steps);
  EXPECT_EQ(stress(rve), voigt(expected.stress));
  settings.strain_rate = 50;
  isostat_rve *fast = create(&settings);
  ASSERT_EQ(isostat_rve_advance(fast, shear, &response), ISOSTAT_OK);
  EXPECT_EQ(response.steps, 70u); // some 30 would be enough at 50 1/s
}

TEST_F(IsostatRve, RestoreContinuesToTheSameBits)
{
  isostat_rve *rve = create();
  isostat_rve_state *start = nullptr;
  ASSERT_EQ(isostat_rve_save(rve, &start), ISOSTAT_OK);
  ASSERT_EQ(isostat_rve_undrained(rve, shear, nullptr), ISOSTAT_OK);
  const RveState once = state(rve);
  ASSERT_EQ(isostat_rve_advance(rve, rows(test::increment(1)).data(), nullptr), ISOSTAT_OK);
  ASSERT_EQ(isostat_rve_restore(rve, start), ISOSTAT_OK);
  ASSERT_EQ(isostat_rve_undrained(rve, shear, nullptr), ISOSTAT_OK);
  test::expect_same_bits(state(rve), once);
  isostat_rve_state *const first = start; // written over, not made again
  ASSERT_EQ(isostat_rve_save(rve, &start), ISOSTAT_OK);
  EXPECT_EQ(start, first);
  isostat_rve *twin = create(); // one with the same grains
  ASSERT_EQ(isostat_rve_restore(twin, start), ISOSTAT_OK);
  test::expect_same_bits(state(twin), once);
  isostat_rve_state_destroy(start);
}

TEST_F(IsostatRve, AStateOfOtherGrainsIsRefused)
{
  Snapshot harder = test::rve_specimen();
  harder.law->young *= 2;
  write_specimen(folder / "harder.h5", {harder, {}, {}});
  isostat_rve_state *start = nullptr;
  ASSERT_EQ(isostat_rve_save(create(), &start), ISOSTAT_OK);
  isostat_rve *other = create(nullptr, folder / "harder.h5");
  const std::vector<double> before = stress(other);
  expect_error(isostat_rve_restore(other, start), ISOSTAT_BAD_INPUT, {"isostat_rve_restore: ", "other grains"});
  EXPECT_EQ(stress(other), before);
  isostat_rve_state_destroy(start);
}

TEST_F(IsostatRve, BytesContinueToTheSameBits)
{
  isostat_rve *rve = create(), *copy = nullptr;
  ASSERT_EQ(isostat_rve_undrained(rve, shear, nullptr), ISOSTAT_OK);
  const std::vector<std::byte> bytes = pack(rve);
  ASSERT_EQ(isostat_rve_unpack(bytes.data(), bytes.size(), nullptr, &copy), ISOSTAT_OK);
  keep(copy);
  for (isostat_rve *each : {rve, copy})
    ASSERT_EQ(isostat_rve_undrained(each, shear, nullptr), ISOSTAT_OK);
  test::expect_same_bits(state(copy), state(rve));
  uint64_t here = 0, there = 0;
  ASSERT_EQ(isostat_rve_steps(rve, &here), ISOSTAT_OK);
  ASSERT_EQ(isostat_rve_steps(copy, &there), ISOSTAT_OK);
  EXPECT_EQ(there, here);
}

TEST_F(IsostatRve, WrongBytesAreRefused)
{
  isostat_rve *rve = create(), *none = rve;
  std::vector<std::byte> bytes = pack(rve);
  std::size_t room = 10;
  expect_error(isostat_rve_pack(rve, bytes.data(), &room), ISOSTAT_BAD_INPUT, {"isostat_rve_pack: size = 10 bytes"});
  EXPECT_EQ(room, bytes.size());
  expect_error(isostat_rve_unpack(bytes.data(), bytes.size() / 2, nullptr, &none), ISOSTAT_BAD_INPUT,
               {"isostat_rve_unpack: ", "cut short or damaged"});
  EXPECT_EQ(none, nullptr);
  expect_error(isostat_rve_unpack(bytes.data(), 0, nullptr, &none), ISOSTAT_BAD_INPUT, {"packed element"});
  bytes[0] ^= std::byte{1};
  expect_error(isostat_rve_unpack(bytes.data(), bytes.size(), nullptr, &none), ISOSTAT_BAD_INPUT,
               {"no representative"});
}

TEST_F(IsostatRve, ARejectedIncrementLeavesTheState)
{
  isostat_rve_settings settings;
  isostat_rve_default_settings(&settings);
  settings.max_steps = 3;
  isostat_rve *rve = create(), *hurried = create(&settings);
  const RveState before = state(rve);
  const std::vector<double> stress_before = stress(rve);
  const double large[9] = {0, 1, 0, 0, 0, 0, 0, 0, 0}, nan[9] = {not_a_number};
  const int controlled[6] = {1, 1, 1, 0, 0, 0};
  isostat_rve_response response;
  expect_error(isostat_rve_advance(rve, large, &response), ISOSTAT_REJECTED,
               {"isostat_rve_advance: an increment of 1 is larger than 0.01", "Divide it"});
  EXPECT_EQ(std::vector(response.stress, response.stress + 6), stress_before);
  EXPECT_EQ(response.steps, 0u);
  expect_error(isostat_rve_undrained(rve, nan, &response), ISOSTAT_REJECTED,
               {"isostat_rve_undrained: ", "not a number"});
  expect_error(isostat_rve_mixed(rve, shear, stress_before.data(), controlled, -1, nullptr), ISOSTAT_REJECTED,
               {"isostat_rve_mixed: ", "tolerance"});
  test::expect_same_bits(state(rve), before);
  expect_error(isostat_rve_advance(hurried, shear, nullptr), ISOSTAT_REJECTED, {"would take"});
  test::expect_same_bits(state(hurried), before);
}

TEST_F(IsostatRve, WrongSpecimensAreRefused)
{
  isostat_rve *none = nullptr;
  expect_error(isostat_rve_create((folder / "nothing.h5").c_str(), nullptr, &none), ISOSTAT_BAD_INPUT,
               {"isostat_rve_create: ", "nothing.h5"});
  expect_error(isostat_rve_create(put("text.h5", "no specimen").c_str(), nullptr, &none), ISOSTAT_BAD_INPUT,
               {"text.h5"});
  Snapshot boxed = test::rve_specimen();
  boxed.cell.reset();
  boxed.box = {Vec3::Constant(-1), Vec3::Constant(1)};
  write_specimen(folder / "boxed.h5", {boxed, {}, {}});
  expect_error(isostat_rve_create((folder / "boxed.h5").c_str(), nullptr, &none), ISOSTAT_BAD_INPUT,
               {"needs a periodic packing"});
  LibraryWriter library = LibraryWriter::create(folder / "library.h5");
  library.add("s0001", {test::rve_specimen(), {}, {}});
  library.commit();
  expect_error(isostat_rve_create((folder / "library.h5").c_str(), nullptr, &none), ISOSTAT_BAD_INPUT, {"s0001"});
  EXPECT_EQ(none, nullptr);
  EXPECT_EQ(stress(create(nullptr, (folder / "library.h5#s0001").string())), stress(create()));
}

TEST_F(IsostatRve, WrongSettingsAreRefused)
{
  const auto refused = [&](auto isostat_rve_settings::*member, auto value, const std::string &part) {
    isostat_rve_settings settings;
    isostat_rve *none = nullptr;
    isostat_rve_default_settings(&settings);
    settings.*member = value;
    expect_error(isostat_rve_create(path.c_str(), &settings, &none), ISOSTAT_BAD_INPUT, {part});
    EXPECT_EQ(none, nullptr);
  };
  for (const double bad : {0.0, -1.0, 1.0, not_a_number})
    refused(&isostat_rve_settings::inertial_number, bad, "inertial_number = ");
  for (const double bad : {-1.0, not_a_number, std::numeric_limits<double>::infinity()})
    refused(&isostat_rve_settings::strain_rate, bad, "strain_rate = ");
  for (const double bad : {-0.1, 1.0, not_a_number})
    refused(&isostat_rve_settings::damping, bad, "damping = ");
  for (const double bad : {0.0, 0.2, not_a_number})
    refused(&isostat_rve_settings::max_increment, bad, "max_increment = ");
  refused(&isostat_rve_settings::min_steps, uint64_t{0}, "min_steps");
  refused(&isostat_rve_settings::max_steps, uint64_t{0}, "max_steps");
  isostat_rve_settings zero = {};
  isostat_rve *none = nullptr;
  expect_error(isostat_rve_create(path.c_str(), &zero, &none), ISOSTAT_BAD_INPUT, {"isostat_rve_default_settings()"});
  isostat_rve_default_settings(&zero);
  zero.frame[0] = 2;
  expect_error(isostat_rve_create(path.c_str(), &zero, &none), ISOSTAT_BAD_INPUT, {"must be a rotation"});
}

TEST_F(IsostatRve, NullHandlesAreErrorsWithAMessage)
{
  double numbers[36];
  const int controlled[6] = {};
  uint64_t steps;
  std::size_t size = 0;
  isostat_rve_state *state = nullptr;
  const std::vector<std::string> no_handle = {"the handle `rve` is null"};
  for (auto *increment : {isostat_rve_advance, isostat_rve_undrained})
    expect_error(increment(nullptr, shear, nullptr), ISOSTAT_BAD_INPUT, no_handle);
  expect_error(isostat_rve_mixed(nullptr, shear, numbers, controlled, 1e-3, nullptr), ISOSTAT_BAD_INPUT, no_handle);
  expect_error(isostat_rve_stress(nullptr, numbers), ISOSTAT_BAD_INPUT, no_handle);
  expect_error(isostat_rve_stiffness(nullptr, 1, numbers), ISOSTAT_BAD_INPUT, no_handle);
  expect_error(isostat_rve_void_ratio(nullptr, numbers), ISOSTAT_BAD_INPUT, no_handle);
  expect_error(isostat_rve_densities(nullptr, 1000, numbers, numbers), ISOSTAT_BAD_INPUT, no_handle);
  expect_error(isostat_rve_steps(nullptr, &steps), ISOSTAT_BAD_INPUT, no_handle);
  expect_error(isostat_rve_save(nullptr, &state), ISOSTAT_BAD_INPUT, no_handle);
  expect_error(isostat_rve_restore(nullptr, state), ISOSTAT_BAD_INPUT, no_handle);
  expect_error(isostat_rve_pack(nullptr, nullptr, &size), ISOSTAT_BAD_INPUT, no_handle);
  isostat_rve_destroy(nullptr);
  isostat_rve_state_destroy(nullptr);
  isostat_rve_default_settings(nullptr);
}

TEST_F(IsostatRve, NullPointersAreErrorsWithAMessage)
{
  isostat_rve *rve = create(), *none = nullptr;
  const int controlled[6] = {};
  const double target[6] = {};
  const auto refused = [](isostat_status status, const std::string &name) {
    expect_error(status, ISOSTAT_BAD_INPUT, {name + " is a null pointer"});
  };
  refused(isostat_rve_create(nullptr, nullptr, &none), "specimen");
  refused(isostat_rve_create(path.c_str(), nullptr, nullptr), "rve");
  refused(isostat_rve_advance(rve, nullptr, nullptr), "gradient");
  refused(isostat_rve_undrained(rve, nullptr, nullptr), "gradient");
  refused(isostat_rve_mixed(rve, nullptr, target, controlled, 1e-3, nullptr), "gradient");
  refused(isostat_rve_mixed(rve, shear, nullptr, controlled, 1e-3, nullptr), "stress");
  refused(isostat_rve_mixed(rve, shear, target, nullptr, 1e-3, nullptr), "controlled");
  refused(isostat_rve_stress(rve, nullptr), "stress");
  refused(isostat_rve_stiffness(rve, 1, nullptr), "stiffness");
  refused(isostat_rve_void_ratio(rve, nullptr), "void_ratio");
  refused(isostat_rve_steps(rve, nullptr), "steps");
  refused(isostat_rve_save(rve, nullptr), "state");
  expect_error(isostat_rve_restore(rve, nullptr), ISOSTAT_BAD_INPUT, {"the handle `state` is null"});
  refused(isostat_rve_pack(rve, nullptr, nullptr), "size");
  refused(isostat_rve_unpack(nullptr, 8, nullptr, &none), "bytes");
  expect_error(isostat_rve_densities(rve, -1, nullptr, nullptr), ISOSTAT_BAD_INPUT, {"water = -1 kg/m3"});
}

TEST_F(IsostatRve, EachThreadHasItsOwnMessage)
{
  expect_error(isostat_rve_steps(nullptr, nullptr), ISOSTAT_BAD_INPUT, {"isostat_rve_steps: "});
  std::thread([] { EXPECT_STREQ(isostat_rve_error(), ""); }).join();
  EXPECT_EQ(std::string(isostat_rve_error()).rfind("isostat_rve_steps: ", 0), 0u);
}
} // namespace isostat
