// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/scene_options.hpp"

namespace isostat
{
void add_scene_options(CommandLine &line, SceneOptions &o, const SceneOptionTexts &texts)
{
  line.option("scene", o.scene, texts.scene).shipped_in("scenes");
  line.option("-o,--output", o.output, "results folder (default: results/<scene name>)");
  line.option("--set", o.set, std::string("override a key, e.g. --set ") + texts.example + " (repeatable)");
  line.flag("--validate", o.validate, "check the scene, print it with every key, and stop");
  line.flag("--print-defaults", o.print_defaults, "print a commented scene with all keys, units and ranges");
  const auto overwrite = line.flag("--overwrite", o.overwrite, "replace results that are there");
  if (texts.manual)
    {
      line.flag("--print-manual", o.print_manual, std::string("print ") + texts.manual + ": every key of a scene");
      line.flag("--resume", o.resume, "go on from the newest checkpoint, to the same bits").excludes(overwrite);
    }
  line.flag("-q,--quiet", o.quiet, "no progress on stderr");
  line.flag("--no-figures", o.no_figures, "do not draw figures at the end");
  line.option("-t,--threads", o.threads, texts.threads).within(0, 1024);
}
} // namespace isostat
