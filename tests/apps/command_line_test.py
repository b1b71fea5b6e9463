# SPDX-License-Identifier: BSD-3-Clause
"""Mistakes on the command line of element_test: exit code, message with its place, and that nothing is lost."""
import gzip
import os
import pathlib
import re
import shutil
import tempfile

from support import BIN, CYCLIC, DISK, ROOT, AppTest, contents, tiny_scene


class SceneMistakes(AppTest):
    def refuse(self, text, *parts):
        scene = self.write("scene.toml", text)
        self.assert_refused(self.run_test(scene, "-o", "out"), *parts)
        self.assertFalse((self.folder / "out").exists())

    @staticmethod
    def line_of(text, part):
        return next(n for n, line in enumerate(text.splitlines(), 1) if part in line)

    def test_unknown_key(self):
        text = tiny_scene(motion="dampnig = 0.2")
        self.refuse(text, f"scene.toml:{self.line_of(text, 'dampnig')}:", "dampnig", "damping")

    def test_missing_scene(self):
        self.assert_refused(self.run_test("nowhere.toml"), "nowhere.toml", "does not exist")

    def test_no_scene(self):
        self.assert_refused(self.run_app("element_test"), "no scene given", "--help")

    def test_unknown_option(self):
        self.assertEqual(self.run_test("scene.toml", "--overwite").returncode, 2)
        for command, option, meant in (("resistance", "--ratois", "ratios"), ("library", "--overwite=1", "overwrite"),
                                       ("compare", "--outptu", "output"), ("study paper", "--jbos", "jobs")):
            result = self.run_app("isostat", *command.split(), option)
            self.assert_refused(result, f"error: {option.split('=')[0]}: unknown option. Did you mean --{meant}?\n"
                                f"Run isostat {command} --help")

    def test_jobs(self):
        """0 is as many as there are cores, in every program; then the scene is looked for."""
        for program in ("isostat calibrate", "isostat resistance", "isostat ensemble", "isostat library"):
            name, *command = program.split()
            if not (BIN / name).exists():
                continue
            more = {"resistance": ["--ratios", "0.2"], "ensemble": ["-n", "2"]}.get(command[0], [])
            for n in (-1, 1025):
                result = self.run_app(name, *command, "none.toml", *more, "--jobs", n)
                self.assertEqual(result.returncode, 2, program)
                self.assertRegex(result.stderr, "0 (to|-) 1024|0, 1024]")  # CLI11 of Debian 12 and of 13, Python
            result = self.run_app(name, *command, "none.toml", *more, "--jobs", 0)
            self.assertEqual(result.returncode, 2, program)
            self.assertIn("none.toml", result.stderr)
            self.assertRegex(self.run_app(name, *command, "--help").stdout,
                             r"0:\s+(as many as the machine has cores|one\s+for\s+each\s+core)")

    def test_validate_writes_nothing(self):
        scene = self.write("scene.toml", tiny_scene())
        self.assert_done(self.run_app("element_test", scene, "--validate"))
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), ["scene.toml", "specimens"])


class SpecimenMistakes(AppTest):
    def refuse(self, *parts):
        """A run with --overwrite into old results: refused, and the old results are all there."""
        old = self.folder / "out"
        old.mkdir()
        (old / "scene.toml").write_text("# old", encoding="utf-8")
        (old / "provenance.txt").write_text("old", encoding="utf-8")
        (old / "history.csv").write_text("old", encoding="utf-8")
        before = contents(old)
        scene = self.write("scene.toml", tiny_scene(specimen='file = "specimen.h5"'))
        self.assert_refused(self.run_test(scene, "-o", "out", "--overwrite"), "specimen.h5", *parts)
        self.assertEqual(contents(old), before)

    def make_specimen(self):
        scene = self.write("make.toml", tiny_scene(stages=CYCLIC.format(steps=10)))
        self.assert_done(self.run_test(scene, "-o", "made"))
        made = next(self.cache.glob("specimen-*.h5"))
        specimen = self.folder / "specimen.h5"
        specimen.write_bytes(made.read_bytes())
        return specimen

    def test_missing(self):
        self.refuse("scene.toml:", "specimen.file", "does not exist")

    def test_damaged_cache(self):
        scene = self.write("make.toml", tiny_scene(stages=CYCLIC.format(steps=10)))
        own = ("--set", "specimen.cache=own")
        self.assert_done(self.run_test(scene, "-o", "made", *own))
        (cached,) = (self.folder / "own").glob("specimen-*.h5")
        whole = cached.read_bytes()
        cached.write_bytes(whole[: len(whole) // 2])
        result = self.run_test(scene, "-o", "again", *own)
        self.assert_done(result)
        self.assertIn("prepared again, because the one in the cache is damaged", result.stderr)
        self.assertEqual(cached.stat().st_size, len(whole))
        self.assertEqual(*((self.folder / name / "history.csv").read_bytes() for name in ("made", "again")))

    def test_friction_left_out(self):
        text = tiny_scene(stages=CYCLIC.format(steps=10))
        frictionless = "".join(line for line in text.splitlines(keepends=True)
                               if not line.startswith(("friction", "rolling", "twisting")))
        for name, scene in ("bare", frictionless), ("usual", text):
            result = self.run_test(self.write(f"{name}.toml", scene), "-o", name)
            self.assertEqual("prepared with a friction of 10 deg and tested with 0 deg" in result.stderr,
                             name == "bare", result.stderr)

    def test_less_friction_than_in_preparation(self):
        """The void ratio that it costs, of a specimen that is made and of one from the cache."""
        scene = self.write("scene.toml", tiny_scene(stages=CYCLIC.format(steps=10)))
        for name in "made", "cached":
            result = self.run_test(scene, "-o", name, "--set", "contact.friction=2 deg")
            self.assertRegex(result.stderr, "with the friction of 2 deg of the test in place of 10 deg the void ratio "
                                            r"falls from 0\.\d+ to 0\.\d+", name)

    def test_limits_of_other_grains(self):
        scene = self.write("scene.toml", tiny_scene(stages=CYCLIC.format(steps=10)))
        for setting, other in (("contact.rolling.limit=0.5", None),
                               ("contact.friction=25 deg", "this scene has contact.friction = 25 deg. Find its own"),
                               ("grading.truncate=[5, 95]", "this scene has grading.truncate = [5, 95]. Find its own")):
            result = self.run_test(scene, "-o", "out", "--overwrite", "--set", setting)
            self.assertEqual("D_r is relative to e_min = 0.568" in result.stderr, bool(other), result.stderr)
            self.assertIn(other or "", result.stderr)

    def test_contradicted_by_the_scene(self):
        self.make_specimen()
        text = tiny_scene(specimen='file = "specimen.h5"', stages=CYCLIC.format(steps=10))
        scene = self.write("scene.toml", text)
        said = "--set", "grading.grains=77", "--set", "specimen.pressure=20 kPa"
        result = self.run_test(scene, "-o", "out", "-q", *said)
        self.assert_done(result)
        for part in ("specimen.h5: is taken as it is", "grading.grains = 77 (200)", "specimen.pressure = 20 kPa; the"):
            self.assertIn(part, result.stderr)
        resolved = (self.folder / "out/scene.toml").read_text(encoding="utf-8")
        self.assertIn("[grading]\ngrains = 77\n\n", resolved.replace('cloud_edge = "2.7 mm"\n', ""))
        self.assertIn('pressure = "20 kPa"', resolved)
        self.assertRegex((self.folder / "out/provenance.txt").read_text(), r"\nspecimen +200 grains")
        again = self.run_test("out/scene.toml", "-o", "again", "-q")  # is held against the packing likewise
        self.assertIn("grading.grains = 77 (200)", again.stderr)
        self.assertIn("this run has finished", self.run_test(scene, "-o", "out", "--resume", *said).stdout)
        self.assert_refused(self.run_test(scene, "-o", "out", "--resume"), "it has `grains = 77` where this one has")
        self.assert_refused(self.run_test(scene, "-o", "soft", "--set", "contact.young=1 GPa"), "specimen.h5: was made",
                            "contact.young = 1 GPa (0.5 GPa)", "begin with a stage `rebalance`")
        self.assert_refused(self.run_test(scene, "-o", "soft", "--set", "contact.law=hertz-mindlin"),
                            'contact.law = "hertz-mindlin" ("linear-rolling")')
        result = self.run_test(scene, "-o", "smooth", "--set", "contact.friction=9 deg")
        self.assertIn("in balance with a friction of 18 deg and tested with 9 deg", result.stderr)

    def test_next_to_the_scene(self):
        self.make_specimen()
        (self.folder / "scenes").mkdir()
        (self.folder / "specimen.h5").rename(self.folder / "scenes/specimen.h5")
        self.write("scenes/scene.toml", tiny_scene(specimen='file = "specimen.h5"'))
        self.assert_done(self.run_test("scenes/scene.toml", "-o", "out"))
        text = (self.folder / "out/scene.toml").read_text(encoding="utf-8")
        self.assertIn(str(self.folder / "scenes/specimen.h5"), text)

    def test_truncated(self):
        specimen = self.make_specimen()
        whole = specimen.read_bytes()
        specimen.write_bytes(whole[: len(whole) // 2])
        self.refuse("truncated")

    def test_density_out_of_reach(self):
        old = self.folder / "out"
        old.mkdir()
        (old / "scene.toml").write_text("# old", encoding="utf-8")
        (old / "provenance.txt").write_text("old", encoding="utf-8")
        scene = self.write("scene.toml", tiny_scene(specimen="void_ratio = 0.3"))
        stiff = ("--set", "contact.young=10 GPa")
        self.assert_refused(self.run_test(scene, "-o", "out", "--overwrite", *stiff), "cannot be reached", "0.3000",
                            "without friction", "the densest possible", "periodic-cell")
        self.assertEqual((old / "scene.toml").read_text(encoding="utf-8"), "# old")
        self.assert_refused(self.run_test(scene, "-o", "results/new", *stiff), "cannot be reached")
        self.assertFalse((self.folder / "results").exists(), "a refused scene leaves no empty folders")


    def test_grains_that_are_no_sand(self):
        scene = self.write("scene.toml", tiny_scene())
        for edge, parts in (("2.7 m", ("largest grain", "in m instead of mm")),
                            ("1e-30 m", ("smallest grain", "clay is no sand"))):
            self.assert_refused(self.run_test(scene, "--set", f"grading.cloud_edge={edge}"),
                                "grading.cloud_edge = ", *parts)

    def test_cell_of_too_few_grains(self):
        scene = self.write("scene.toml", tiny_scene('domain = "periodic-cell"\npreparation_friction = "10 deg"'))
        result = self.run_test(scene, "-o", "out", "--set", "grading.grains=12")
        self.assert_refused(result, "grading.grains = 12", "at once. Take", "or more")
        self.assertFalse((self.folder / "out").exists())


class Version(AppTest):
    def test_every_program_says(self):
        programs = [path.parent.name for path in ROOT.glob("apps/*/main.cpp") if (BIN / path.parent.name).exists()]
        self.assertIn("element_test", programs)
        for program in [*programs, "isostat"]:
            result = self.run_app(program, "--version")
            self.assert_done(result)
            self.assertRegex(result.stdout, rf"^{program}( \(Isostat\))? \d+\.\d+\.\d+ ")


class Bare(AppTest):
    def test_isostat_alone_lists_its_commands(self):
        programs = [name for name in ("element_test", "soil_column") if (BIN / name).exists()]
        for words in ((), ("--help",)):
            result = self.run_app("isostat", *words)
            self.assert_done(result)
            for word in ("library", "calibrate", "compare", "report", *programs):
                self.assertRegex(result.stdout, rf"(?m)^  {word} ")
        self.assert_refused(self.run_app("isostat", "librray"), "librray: unknown command of isostat. Did you mean "
                            "library?")

    def test_a_reader_that_stops_reading(self):
        for words in ((), ("sands",)):
            done = self.run_command(["sh", "-c", '"$0" "$@" | true', str(BIN / "isostat"), *words])
            self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_isostat_calls_programs(self):
        """With what follows, and their exit codes."""
        self.assertEqual(self.run_app("isostat", "element_test", "--print-defaults").stdout,
                         self.run_app("element_test", "--print-defaults").stdout)
        self.assert_refused(self.run_app("isostat", "element_test", "nowhere.toml"), "nowhere.toml")

    def test_a_scene_of_too_long_a_name(self):
        for words in (("element_test",), ("isostat", "library"), ("isostat", "resistance", "--ratios", "0.2")):
            self.assert_refused(self.run_app(*words, "x" * 300), "x" * 300)


class Copied(AppTest):
    def test_a_copied_program_says_what_it_misses(self):
        there = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(dir=DISK)))
        for program in ("isostat", "element_test"):
            shutil.copy(BIN / program, there / program)
        self.assert_refused(self.run_app(there / "isostat", "report", "x"), "python/isostat does not exist",
                            "copied", "built or installed")
        (self.folder / "link").symlink_to(BIN / "isostat")
        self.assert_done(self.run_app(self.folder / "link", "--version"))
        scene = self.write("scene.toml", tiny_scene(stages=CYCLIC.format(steps=600)))
        result = self.run_app(there / "element_test", scene, "-o", "out")
        self.assert_done(result)
        self.assertIn("figures were not drawn: ", result.stdout)
        self.assertIn("share/isostat/report does not exist", result.stdout)


class Readme(AppTest):
    def test_its_programs_are_built_by_the_demo(self):
        demo = (ROOT / "scripts/demo.sh").read_text(encoding="utf-8")
        built = re.search(r"--target ((?:.*\\\n)*.*)", demo)[1].split()
        named = re.findall(r"build/release/bin/(\w+)", (ROOT / "README.md").read_text(encoding="utf-8"))
        self.assertIn("soil_column", named)
        self.assertLessEqual(set(named), set(built))


class OutputFolder(AppTest):
    def setUp(self):
        super().setUp()
        self.scene = self.write("scene.toml", tiny_scene(stages=CYCLIC.format(steps=600)))

    def test_below_a_file(self):
        self.write("file", "precious")
        self.assert_refused(self.run_test(self.scene, "-o", "file/out"), "file/out", "cannot be made", "--output")
        self.assertEqual((self.folder / "file").read_text(encoding="utf-8"), "precious")

    def test_is_a_file(self):
        self.write("file", "precious")
        for flag in ((), ("--overwrite",)):
            self.assert_refused(self.run_test(self.scene, "-o", "file", *flag), "file", "not a folder")
        self.assertEqual((self.folder / "file").read_text(encoding="utf-8"), "precious")

    def test_existing_results(self):
        self.assert_done(self.run_test(self.scene, "-o", "out"))
        self.assert_refused(self.run_test(self.scene, "-o", "out"), "out", "exists", "--overwrite", "--resume")
        shutil.rmtree(self.folder / "out/checkpoint")
        before = contents(self.folder / "out")
        refused = self.run_test(self.scene, "-o", "out")
        self.assert_refused(refused, "out", "exists", "--overwrite")
        self.assertNotIn("--resume", refused.stderr)  # there is no checkpoint
        self.assertEqual(contents(self.folder / "out"), before)
        self.assert_done(self.run_test(self.scene, "-o", "out", "--overwrite"))
        self.assertEqual(contents(self.folder / "out")["history.csv"], before["history.csv"])

    def test_empty_folder_and_slash(self):
        (self.folder / "out").mkdir()
        self.assert_done(self.run_test(self.scene, "-o", "out/"))
        self.assertTrue((self.folder / "out/history.csv").exists())
        self.assertFalse((self.folder / "out/specimens").exists())

    def test_overwrite_of_something_else(self):
        other = self.folder / "thesis"
        other.mkdir()
        (other / "chapter.tex").write_text("precious", encoding="utf-8")
        self.assert_refused(self.run_test(self.scene, "-o", "thesis", "--overwrite"), "thesis", "not overwritten",
                            "scene.toml")
        self.assertEqual(contents(other), {"chapter.tex": b"precious"})
        self.write("thesis/scene.toml", tiny_scene())  # a user's file, not of a run
        before = contents(self.folder)
        for place, scene in (("thesis", self.scene), (".", "thesis/scene.toml"), ("thesis/.", "thesis/scene.toml")):
            self.assert_refused(self.run_test(scene, "-o", place, "--overwrite"), "not overwritten", "holds no ")
        self.assertEqual(contents(self.folder), before)

    def test_what_was_not_meant(self):
        (self.folder / "folder").mkdir()
        (self.folder / "scene.toml.gz").write_bytes(gzip.compress(tiny_scene().encode()))
        (self.folder / "link").symlink_to("nowhere")
        os.mkfifo(self.folder / "pipe")
        for said, arguments in (("folder: is a folder; must be a scene file", ("folder",)),
                                ("pipe: is a pipe or a device; must be a scene file", ("pipe",)),
                                ("zero: is a pipe or a device; must be a scene file", ("/dev/zero",)),
                                ("is compressed; must be a scene file (TOML). Unpack it", ("scene.toml.gz",)),
                                ("link: is a link to nowhere, which does not exist", (self.scene, "-o", "link")),
                                ("a point in its number, no comma", (self.scene, "--set", "specimen.pressure=0,5 kPa")),
                                ("error: The following argument was not expected: --bogus", (self.scene, "--bogus"))):
            with self.subTest(said):
                self.assert_refused(self.run_test(*arguments), said)

    def test_a_stage_that_cannot_begin(self):
        """Known only when the stage before has ended, and still a mistake of the scene."""
        stages = ('[[stage]]\nkind = "drained"\nstrain = 0.001\n[[stage]]\nkind = "undrained-cyclic"\n'
                  'deviator_average = "500 kPa"\ndeviator_amplitude = "10 kPa"')
        self.assert_refused(self.run_test(self.write("biased.toml", tiny_scene(stages=stages)), "-o", "out"),
                            "stage 1 (undrained-cyclic): q = ", "when it begins")

    def test_a_folder_whose_run_was_killed_as_it_began(self):
        """Or as it removed older results: their scene goes before their provenance."""
        for out, flag in (("out", ()), ("other", ("--overwrite",))):
            (self.folder / out).mkdir()
            for name in (".lock", ".writable", "provenance.txt", "scene.toml.tmp"):
                (self.folder / out / name).touch()
            self.assert_done(self.run_test(self.scene, "-o", out, *flag))

    def test_resume_of_nothing(self):
        self.assert_refused(self.run_test(self.scene, "-o", "out", "--resume"), "out", "nothing to resume")
        self.assertFalse((self.folder / "out").exists())
        self.assert_done(self.run_test(self.scene, "-o", "out"))
        (self.folder / "out/summary.json").unlink()  # as if it had been killed before its first checkpoint
        shutil.rmtree(self.folder / "out/checkpoint")
        before = contents(self.folder / "out")
        self.assert_refused(self.run_test(self.scene, "-o", "out", "--resume"), "nothing to resume",
                            "ended before its first checkpoint", "--overwrite")
        self.assertEqual(contents(self.folder / "out"), before)

    def test_resume_of_a_finished_run(self):
        self.assert_done(self.run_test(self.scene, "-o", "out"))
        before = contents(self.folder / "out")
        result = self.run_test(self.scene, "-o", "out", "--resume")
        self.assert_done(result)
        self.assertIn("this run has finished; there is nothing to resume", result.stdout)
        self.assertEqual(contents(self.folder / "out"), before)

    def test_resume_and_overwrite_exclude_each_other(self):
        result = self.run_test(self.scene, "-o", "out", "--resume", "--overwrite")
        self.assertEqual(result.returncode, 2)

    def test_resume_with_another_scene(self):
        every_256_steps = ("--set", "output.checkpoint=1e-9 min")
        self.assert_done(self.run_test(self.scene, "-o", "out", *every_256_steps))
        self.assertTrue((self.folder / "out/checkpoint/last.h5").exists())
        before, specimens = contents(self.folder / "out"), contents(self.cache)
        for change in ("motion.damping=0.25", "specimen.pressure=100 kPa"):
            result = self.run_test(self.scene, "-o", "out", "--resume", *every_256_steps, "--set", change)
            self.assert_refused(result, "another scene", "out", change.split(".")[1].split("=")[0])
        self.assertEqual(contents(self.folder / "out"), before)
        self.assertEqual(contents(self.cache), specimens)  # nothing was prepared for the refused ones

    def test_damaged_checkpoints(self):
        every_256_steps = ("--set", "output.checkpoint=1e-9 min")
        self.assert_done(self.run_test(self.scene, "-o", "out", *every_256_steps))
        for checkpoint in (self.folder / "out/checkpoint").iterdir():
            checkpoint.write_bytes(checkpoint.read_bytes()[:1000])
        (self.folder / "out/summary.json").unlink()  # as if it had been stopped before its end
        before = contents(self.folder / "out")
        self.assert_refused(self.run_test(self.scene, "-o", "out", "--resume", *every_256_steps), "last.h5")
        self.assertEqual(contents(self.folder / "out"), before)
