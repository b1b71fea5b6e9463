// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/verification/programme_test.cpp, tests/verification/cell_programme_test.cpp
#pragma once
#include "dem/drive/programme.hpp"
#include "dem/io/specimen_file.hpp"
#include "dem/scene/scene.hpp"

#include <filesystem>

namespace isostat
{
/// The specimen that a scene asks for: read from a file, taken from the cache, or prepared
/// (cloud -> compression at a preparation friction -> friction of shearing -> rebalance) and put into the cache.
/// A library entry, "library.h5#s0007", is a file, too. May be called from several threads, each with an observer of
/// its own, for different recipes.
/// @param cache  folder of prepared specimens, named by a hash of their recipe; the recipe itself is compared as well
/// @param threads  that share a step of the preparation, see StepSettings; changes no bit of the specimen
/// @throws InputError  a density that cannot be reached, a file that is not a specimen
/// @throws Interrupted
/// tested: tests/verification/programme_test.cpp, tests/apps/library_test.py
Specimen obtain_specimen(const Scene &scene, const std::filesystem::path &cache, RunObserver &observer,
                         int threads = 1);

/// A packing that a program gives, as the specimen of a scene: time and strain count from here, its figures are those
/// of the packing, the contact law is the scene's.   @throws InputError  as check_given_packing()
/// tested: tests/python/run_test.py
Specimen given_specimen(const Scene &scene, Specimen given);

/// All that a prepared specimen depends on, as text: the key of the cache and part of its provenance.
std::string specimen_recipe(const Scene &scene);

/// Where a cache keeps the specimen of a scene once it is prepared.
std::filesystem::path cached_specimen(const Scene &scene, const std::filesystem::path &cache);
} // namespace isostat
