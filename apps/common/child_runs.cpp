// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/child_runs.hpp"

#include "apps/common/interrupt.hpp"
#include "base/error.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fmt/format.h>
#include <thread>
#include <unistd.h>

namespace isostat
{
namespace fs = std::filesystem;

namespace
{
constexpr double patience = 30;        ///< s that a helper waits for somebody to help
constexpr double revival_interval = 2; ///< s between looks for runs whose process has died

/// The runs of a queue that this process does.
class Worker
{
public:
  /// @param gives_back  a run that was stopped is left to another process; else it counts as ended
  Worker(const RunPool &pool, bool gives_back)
      : queue_(pool.queue), jobs_(static_cast<std::size_t>(pool.jobs)), gives_back_(gives_back)
  {}
  bool idle() const { return running_.empty(); }
  std::size_t n_done() const { return n_done_; }

  void start()
  {
    while (running_.size() < jobs_)
      {
        std::optional<TaskQueue::Claim> claim = queue_.claim();
        if (!claim)
          return;
        ChildProcess child(claim->run, claim->lock.descriptor());
        running_.push_back({std::move(*claim), child});
      }
  }

  /// Asks all to end; once.
  void stop()
  {
    for (const Running &each : running_)
      if (!stopped_)
        each.child.stop();
    stopped_ = true;
  }

  void finish_ended()
  {
    std::erase_if(running_, [&](Running &each) {
      const std::optional<int> code = each.child.ended();
      if (code && !(stopped_ && gives_back_))
        {
          queue_.finish(each.claim, {*code, each.child.seconds()});
          ++n_done_;
        }
      return code.has_value();
    });
  }

private:
  struct Running
  {
    TaskQueue::Claim claim;
    ChildProcess child;
  };
  TaskQueue &queue_;
  std::size_t jobs_, n_done_ = 0;
  std::vector<Running> running_;
  bool gives_back_, stopped_ = false;
};

void rest() { std::this_thread::sleep_for(std::chrono::milliseconds(100)); }

/// The session of a leader, which may be about to begin. A session that was over when this process looked first is that
/// of an earlier call; empty if it came and went meanwhile.
std::string await_session(const TaskQueue &queue, const fs::path &folder)
{
  const std::string earlier = queue.last_session();
  for (const Stopwatch watch; watch.seconds() < patience && !stop_requested(); rest())
    {
      const bool begun = queue.last_session() != earlier; // looked at first: by now it is open, or it is over
      const std::string session = queue.open_session();
      if (!session.empty() || begun)
        return session;
    }
  if (stop_requested())
    throw Interrupted("interrupted");
  throw InputError(fmt::format("{}: nobody leads runs there. Start the same command without --helper on a machine that "
                               "sees this folder.",
                               folder.string()));
}

/// Takes what the launcher left out of the environment: MPI programs that this process starts are no ranks of it.
void forget_launch()
{
  constexpr std::string_view launched[] = {"OMPI_", "PMIX_", "PMI_", "SLURM_"}, kept = "OMPI_ALLOW_RUN_AS_ROOT";
  std::vector<std::string> names;
  for (char **entry = environ; *entry; ++entry)
    {
      const std::string_view text = *entry, name = text.substr(0, text.find('='));
      if (!name.starts_with(kept) && std::ranges::any_of(launched, [&](auto word) { return name.starts_with(word); }))
        names.emplace_back(name);
    }
  for (const std::string &name : names)
    unsetenv(name.c_str());
}
} // namespace

bool run_children(const RunPool &pool, const std::vector<ChildRun> &runs, const ChildEvents &events)
{
  TaskQueue &queue = pool.queue;
  std::map<std::size_t, std::size_t> index; // by number in the queue
  for (std::size_t k = 0; k < runs.size(); ++k)
    index[queue.post(runs[k])] = k;
  Worker own(pool, false);
  Stopwatch since_revival;
  for (std::size_t left = runs.size(); left > 0 && !(stop_requested() && own.idle()); rest())
    {
      if (stop_requested())
        {
          queue.withdraw();
          own.stop();
        }
      else
        own.start();
      own.finish_ended();
      for (const auto &[number, done] : queue.take_done())
        {
          events.finished(index.at(number), done.code, done.seconds);
          --left;
        }
      if (since_revival.seconds() > revival_interval)
        {
          queue.give_back_abandoned();
          since_revival.restart();
        }
      std::vector<std::size_t> at_work;
      for (const std::size_t number : queue.claimed())
        at_work.push_back(index.at(number));
      events.tick(at_work);
    }
  return !stop_requested();
}

std::size_t help_with_runs(const fs::path &queue_folder, int jobs)
{
  TaskQueue queue(queue_folder);
  const std::string session = await_session(queue, queue_folder);
  Worker worker({queue, jobs}, true);
  for (bool open = !session.empty(); open || !worker.idle(); rest())
    {
      open = open && !stop_requested() && queue.open_session() == session;
      if (open)
        worker.start();
      else
        worker.stop();
      worker.finish_ended();
    }
  if (stop_requested())
    throw Interrupted("interrupted; what has been run is kept");
  return worker.n_done();
}

Launch launch()
{
  constexpr std::pair<const char *, const char *> launchers[] = {
      {"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"}, {"PMI_RANK", "PMI_SIZE"}, {"SLURM_PROCID", "SLURM_NTASKS"}};
  for (const auto &[rank, size] : launchers)
    if (const char *text = std::getenv(rank))
      {
        const char *all = std::getenv(size);
        return {std::atoi(text), all ? std::atoi(all) : 1};
      }
  return {};
}

int jobs_of_all_cores()
{
  return launch().size > 1 ? 1 : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

void CampaignShare::add_options(CLI::App &line)
{
  line.add_option_function<int>(
          "-j,--jobs", [this](int n) { jobs = n == 0 ? jobs_of_all_cores() : n; },
          "runs side by side in this process, each on one thread (default 1); 0: as many as the machine has cores, of "
          "ranks one each. Results do not depend on it")
      ->check(CLI::Range(0, 1024));
  line.add_flag("--helper", helper,
                "do runs of the same command that another process has begun, on this machine or on one that sees the "
                "same folder; ranks of mpirun and srun above 0 do so by themselves");
}

bool CampaignShare::help(const fs::path &folder) const
{
  const bool helps = helper || launch().rank > 0;
  forget_launch();
  if (!helps)
    return false;
  catch_signals();
  const std::size_t n = help_with_runs(folder / "queue", jobs);
  fmt::print("{}: {} runs done by this helper\n", folder.string(), n);
  return true;
}
} // namespace isostat
