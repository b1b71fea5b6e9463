// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/element/sleeping_element.hpp"

#include "base/error.hpp"
#include "base/files/bytes.hpp"

#include <array>
#include <bit>
#include <chrono>
#include <cstring>
#include <utility>

namespace isostat
{
namespace
{
/// Increments without the components that are zero in all of them: of nine a column has three that are not.
void write_history(ByteWriter &out, const std::vector<Mat3> &history)
{
  std::uint64_t used = 0;
  for (const Mat3 &h : history)
    for (int k = 0; k < 9; ++k)
      used |= std::uint64_t{std::bit_cast<std::uint64_t>(h(k)) != 0} << k;
  std::vector<double> values;
  for (const Mat3 &h : history)
    for (int k = 0; k < 9; ++k)
      if (used >> k & 1)
        values.push_back(h(k));
  out.count(history.size()), out.count(used);
  out.block(std::as_bytes(std::span(values)));
}

std::vector<Mat3> read_history(ByteReader &in)
{
  const std::uint64_t n = in.count(), used = in.count();
  const auto block = in.block();
  const auto width = static_cast<std::size_t>(std::popcount(used));
  if (used > 0x1ff || n > block.size() || block.size() != n * width * sizeof(double))
    in.fail("its history of strains is damaged");
  std::vector<Mat3> history(n, Mat3::Zero());
  const std::byte *from = block.data();
  for (Mat3 &h : history)
    for (int k = 0; k < 9; ++k)
      if (used >> k & 1)
        {
          std::memcpy(&h(k), from, sizeof(double));
          from += sizeof(double);
        }
  return history;
}
} // namespace

SleepingElement::SleepingElement(Rve rve, bool constant_volume, unsigned halvings, bool may_sleep)
    : element_(std::move(rve), constant_volume, halvings), constant_volume_(constant_volume), may_sleep_(may_sleep)
{}

void SleepingElement::sleep(const ElasticStart &start) { sleep_ = Sleep{start, StrainVector::Zero(), {}}; }

ElementTrial SleepingElement::trial(const Mat3 &h)
{
  rollback();
  replay_seconds_ = 0;
  if (!sleep_)
    return element_.trial(h);
  const StrainVector strain = sleep_->strain + strain_vector(h, constant_volume_);
  if (sleep_->start.part_used(strain) <= 1) // not a number: the packing will say so
    {
      if (!h.isZero(0))
        pending_ = Pending{h, strain};
      ElementTrial result;
      result.accepted = true;
      result.stress = stress();
      return result;
    }
  const std::uint64_t missed = wake_up();
  ElementTrial result = element_.trial(h);
  result.steps += missed;
  woken_ = true;
  return result;
}

std::uint64_t SleepingElement::wake_up()
{
  if (initial_)
    return 0;
  const auto begin = std::chrono::steady_clock::now();
  initial_ = element_.rve().save();
  std::uint64_t steps = 0;
  for (std::size_t k = 0; k < sleep_->history.size(); ++k)
    {
      const ElementTrial again = element_.trial(sleep_->history[k]);
      if (!again.accepted)
        {
          back_to_initial();
          throw RunFailure("the packing was asleep, and cannot take the strain of increment " + std::to_string(k + 1) +
                           " that it has missed: " + again.reason + ". Lower elastic_start.");
        }
      element_.commit();
      steps += again.steps;
    }
  replay_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return steps;
}

void SleepingElement::back_to_initial()
{
  if (initial_)
    element_.restart(*initial_);
  initial_.reset();
}

void SleepingElement::commit()
{
  if (woken_)
    {
      sleep_.reset();
      initial_.reset();
      woken_ = false;
    }
  if (!sleep_)
    return element_.commit();
  back_to_initial();
  if (!pending_)
    return;
  sleep_->strain = pending_->strain;
  sleep_->history.push_back(pending_->h);
  pending_.reset();
}

void SleepingElement::rollback()
{
  pending_.reset();
  if (woken_ || !sleep_)
    element_.rollback();
  woken_ = false;
}

const Rve &SleepingElement::rve()
{
  if (asleep())
    back_to_initial();
  return element_.rve();
}

Mat3 SleepingElement::stress() const
{
  return asleep() ? sleep_->start.stress_at(pending_ ? pending_->strain : sleep_->strain) : element_.rve().stress();
}

Stiffness SleepingElement::stiffness() const
{
  return asleep() ? sleep_->start.stiffness : Stiffness(element_.rve().stiffness());
}

Stiffness SleepingElement::committed_stiffness()
{
  return sleep_ ? sleep_->start.stiffness
                : element_.at_committed([](const Rve &rve) { return Stiffness(rve.stiffness()); });
}

std::vector<std::byte> SleepingElement::with_sleep(const std::vector<std::byte> &packing) const
{
  if (!may_sleep_)
    return packing;
  ByteWriter out;
  out.count(sleep_.has_value());
  if (sleep_)
    {
      out.numbers(std::span(sleep_->start.stiffness.data(), 36));
      out.numbers(std::span(sleep_->start.stress.data(), 9));
      out.numbers(std::array{sleep_->start.shear_limit, sleep_->start.other_limit});
      out.numbers(std::span(sleep_->strain.data(), 6));
      write_history(out, sleep_->history);
    }
  out.block(packing);
  return out.take();
}

std::vector<std::byte> SleepingElement::pack()
{
  return with_sleep(sleep_ && initial_ ? element_.pack_of(*initial_) : element_.pack());
}

std::vector<std::byte> SleepingElement::pack_to_move()
{
  if (sleep_)
    back_to_initial();
  return with_sleep(element_.pack_to_move());
}

SleepingElement SleepingElement::unpack(std::span<const std::byte> bytes, const RveSettings &settings,
                                        bool constant_volume, unsigned halvings, bool may_sleep)
{
  if (!may_sleep)
    return {Rve::unpack(bytes, settings), constant_volume, halvings, false};
  ByteReader in(bytes, "rve");
  std::optional<Sleep> sleep;
  if (in.count() != 0)
    {
      sleep.emplace();
      std::array<double, 2> limits{};
      in.numbers(std::span(sleep->start.stiffness.data(), 36), "numbers of stiffness");
      in.numbers(std::span(sleep->start.stress.data(), 9), "numbers of stress");
      in.numbers(limits, "limits");
      in.numbers(std::span(sleep->strain.data(), 6), "numbers of strain");
      sleep->start.shear_limit = limits[0], sleep->start.other_limit = limits[1];
      sleep->history = read_history(in);
    }
  SleepingElement element(Rve::unpack(in.block(), settings), constant_volume, halvings, true);
  in.expect_end();
  element.sleep_ = std::move(sleep);
  return element;
}
} // namespace isostat
