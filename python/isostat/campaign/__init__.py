# SPDX-License-Identifier: BSD-3-Clause
"""Many runs: a table of scenes, each run by a program of Isostat in a folder of its own, by any engine that has the
interface of concurrent.futures.Executor.

    from isostat import campaign

    runs = [campaign.Run.below("results/seeds", f"seed{k}", scene.with_(**{"grading.seed": k})) for k in range(8)]
    with campaign.engine("local", jobs=4) as executor:
        campaign.complete(executor, runs)

`isostat resistance`, `calibrate`, `ensemble` and `library` are modules on top of it.
"""
from isostat.campaign.engines import engine
from isostat.campaign.folder import CampaignFolder
from isostat.campaign.runs import Run, complete

__all__ = ["CampaignFolder", "Run", "complete", "engine"]
