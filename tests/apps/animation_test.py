# SPDX-License-Identifier: BSD-3-Clause
"""isostat animate: a frame for each stored moment of a column and of a test; what it cannot do, it says."""
import h5py
from PIL import Image

import column_fixture as fixture
from support import AppTest


class Animations(AppTest):
    def animate(self, *words):
        return self.run_command(self.command("isostat", "animate", *words))

    def test_a_column(self):
        fixture.packings(self.folder / "run")
        self.assert_done(self.animate("run"))
        with Image.open(self.folder / "run/figures/animation.gif") as film:
            self.assertEqual(film.n_frames, 2)

    def test_an_element_test(self):
        fixture.packings(self.folder / "column")
        run = self.folder / "run"
        (run / "snapshots").mkdir(parents=True)
        self.write("run/history.csv", "step (-),stage (-),p (Pa),q (Pa),eps_y (-)\n"
                   + "".join(f"{10 * k},0,{200e3 - 50e3 * k},{20e3 * k},{1e-3 * k}\n" for k in range(4)))
        for k in range(3):
            path = run / f"snapshots/snapshot_{k:04}.h5"
            path.write_bytes((self.folder / "column/grains/d0_0.h5").read_bytes())
            with h5py.File(path, "a") as file:
                file["snapshot"].attrs["step"] = 10 * k
        self.assert_done(self.animate("run", "-o", "film.gif", "--rate", 10))
        with Image.open(self.folder / "film.gif") as film:
            self.assertEqual((film.n_frames, film.info["duration"]), (3, 100))

    def test_what_it_refuses(self):
        fixture.packings(self.folder / "run")
        self.write("mine.gif", "precious")
        for words, said in ((("run", "-o", "film.avi"), "film.avi: must end with .gif or .mp4"),
                            (("run", "--rate", "0"), "--rate = 0; must be > 0"),
                            (("run", "-o", "none/film.gif"), "none/film.gif: cannot be written: there is no folder"),
                            (("run", "-o", "mine.gif"), "mine.gif: exists and is not a file of this command"),
                            (("film.avi", "run"), "unrecognized arguments"),
                            (("mine.gif",), "mine.gif: is a file, not a results folder"),
                            (("nowhere",), "nowhere: does not exist. Give the results folder")):
            result = self.animate(*words)
            self.assertEqual(result.returncode, 2)
            self.assertIn(said, result.stderr)
        self.assertFalse((self.folder / "nowhere").exists())
        self.assertEqual((self.folder / "mine.gif").read_text(), "precious")
        (self.folder / "run/grains/d0.pvd").unlink()
        self.assertIn("run: has no two moments of stored packings. Run it with", self.animate("run").stderr)
