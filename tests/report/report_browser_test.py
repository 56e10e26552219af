#!/usr/bin/env python3
"""Opens a report as its reader does, from a file in a browser, and uses it: mouse, keys, fingers, printer.

    report_browser_test.py --sample PROGRAM    writes the sample with PROGRAM and checks every detail of it
    report_browser_test.py --report FILE       checks what holds for any report: it works, has numbers, loads nothing

Exit status 77 (skipped) without chromium or chromedriver, unless the environment says PEELRAY_REQUIRE_BROWSER=1.
"""
import argparse
import os
import re
import subprocess
import sys
import tempfile
import unittest

import browser as browsers
from browser import Browser, Picture

BLUE, RED, BLACK, WHITE = (20, 40, 200), (200, 30, 20), (0, 0, 0), (255, 255, 255)
SHIFT, SPACE, LEFT, UP, RIGHT, HOME, END, TAB = "\ue008", " ", "\ue012", "\ue013", "\ue014", "\ue011", "\ue010", "\ue004"


class Page(unittest.TestCase):
    """One browser for all tests of a class, the report opened anew for each."""

    report = None

    @classmethod
    def setUpClass(cls):
        cls.browser = Browser()

    @classmethod
    def tearDownClass(cls):
        cls.browser.close()

    def setUp(self):
        self.browser.call("POST", "/url", {"url": "about:blank"})  # the tab that the browser opened by itself asks for much
        self.browser.cdp("Emulation.clearDeviceMetricsOverride")
        self.browser.cdp("Emulation.setTouchEmulationEnabled", enabled=False)
        self.browser.media()
        self.browser.messages()
        self.browser.requests()
        self.open()

    def tearDown(self):
        self.assertEqual(self.browser.messages(), [], "the page complained")
        asked = {url for url in self.browser.requests() if not url.startswith("data:")}
        self.assertEqual(asked, {Browser.address_of(self.report)}, "the page asked for something")

    def open(self):
        self.browser.open(self.report)
        self.browser.wait("document.documentElement.classList.contains('ready')", "the viewer")

    def text(self, selector):
        return self.browser.run("return document.querySelector(arguments[0]).textContent", selector)

    def texts(self, selector):
        return self.browser.run("return [...document.querySelectorAll(arguments[0])].map(e => e.textContent)", selector)

    def click(self, selector):
        box = self.box(selector)
        self.browser.mouse((box["x"] + box["width"] / 2, box["y"] + box["height"] / 2))

    def box(self, selector):
        return self.browser.run("return document.querySelector(arguments[0]).getBoundingClientRect().toJSON()", selector)

    def split(self):
        return int(self.browser.run("return document.querySelector('[role=slider]').getAttribute('aria-valuenow')"))

    def zoom(self):
        return float(self.text("#zoom").rstrip(" %"))

    def stage_point(self, x, y):
        """The window's point at a share of the stage."""
        box = self.box("#stage")
        return box["x"] + x * box["width"], box["y"] + y * box["height"]

    def drawn(self, *shares):
        """The colours at these shares of the stage; the screenshot may have more than one pixel per CSS pixel."""
        picture = Picture(self.browser.screenshot())
        density = picture.width / self.browser.run("return innerWidth")
        return [picture.at(*(v * density for v in self.stage_point(*share))) for share in shares]


class AnyReport(Page):
    """What holds for every report of at least two pictures."""

    def test_the_slider_moves(self):
        self.browser.mouse(self.stage_point(self.split() / 100, 0.8), self.stage_point(0.6, 0.8), self.stage_point(0.25, 0.8))
        self.assertEqual(self.split(), 25)
        self.browser.run("document.querySelector('[role=slider]').focus()")
        self.browser.key(RIGHT, RIGHT, UP)
        self.assertEqual(self.split(), 28)
        self.browser.key(END)
        self.assertEqual(self.split(), 100)

    def test_what_is_left_of_the_divider_is_the_left_picture(self):
        if len(set(self.browser.run("return [...document.querySelectorAll('#pictures img')].map(i => i.src)"))) < 2:
            self.skipTest("all pictures are the same")
        self.browser.run("state.left = pictures.findIndex(p => p.image.src !== pictures[state.right].image.src); setSplit(1);")
        left = self.browser.screenshot()
        self.browser.run("setSplit(0)")
        self.assertNotEqual(left, self.browser.screenshot())

    def test_the_table_has_numbers(self):
        cells = self.texts("#metrics tbody td")
        self.assertGreaterEqual(len(cells), 5)
        for index, cell in enumerate(cells):
            if index % 5 != 3 or cell != "–":  # HDR-FLIP: pictures without radiance have none
                self.assertRegex(cell, r"^(∞|[<>]? ?-?\d+\.\d+( dB| %)?)$")

    def test_every_picture_is_there_and_of_one_size(self):
        sizes = self.browser.run("return [...document.querySelectorAll('#pictures img')].map(i => [i.complete, i.naturalWidth, i.naturalHeight])")
        self.assertGreaterEqual(len(sizes), 2)
        self.assertEqual(len({tuple(size) for size in sizes}), 1)
        self.assertTrue(sizes[0][0] and sizes[0][1] > 0)

    def test_it_zooms_and_fits(self):
        self.browser.wait("state.fitted && document.querySelector('#zoom').textContent !== ''", "the first drawing")
        self.browser.settle()  # the page's last change of size
        fitted = self.zoom()
        self.browser.wheel(*self.stage_point(0.3, 0.3), -600)
        self.browser.wait(f"parseFloat(document.querySelector('#zoom').textContent) > {fitted}", "the zoom")
        self.browser.key("o")
        self.browser.wait("document.querySelector('#zoom').textContent === '100 %'", "1:1")
        self.browser.key("0")
        self.browser.wait(f"state.fitted && Math.abs(parseFloat(document.querySelector('#zoom').textContent) - {fitted}) <= 1", "the fit")

    def test_nothing_is_wider_than_the_window(self):
        for width in (1400, 900, 561, 390, 320):
            self.browser.phone(width, 844, 1)
            self.assertEqual(self.browser.run("return document.documentElement.scrollWidth"), width)


class Sample(Page):
    """The report of sample_report.cpp: pictures 1 to 5 are the reference (blue), red, equal and two error maps."""

    def test_shows_both_pictures_and_moves_by_mouse(self):
        self.assertEqual(self.drawn((0.3, 0.2), (0.7, 0.2)), [RED, BLUE])
        start = self.stage_point(0.5, 0.5)
        self.browser.mouse(start, self.stage_point(0.9, 0.5), self.stage_point(0.8, 0.5))
        self.assertEqual(self.split(), 80)
        self.assertEqual(self.drawn((0.3, 0.2), (0.7, 0.2)), [RED, RED])
        # With the whole picture in view a drag may begin anywhere, and a click puts the divider there.
        self.browser.mouse(self.stage_point(0.4, 0.3), self.stage_point(0.2, 0.3))
        self.assertEqual(self.drawn((0.3, 0.2), (0.7, 0.2)), [BLUE, BLUE])
        self.browser.mouse(self.stage_point(0.6, 0.1))
        self.assertEqual(self.split(), 60)

    def test_moves_by_keys_as_a_slider(self):
        self.browser.run("[...document.querySelectorAll('.bar button')].pop().focus()")
        self.browser.key(TAB)
        self.assertEqual(self.browser.run("return document.activeElement.getAttribute('role')"), "slider")
        self.browser.key(HOME)
        self.assertEqual(self.drawn((0.3, 0.2), (0.7, 0.2)), [BLUE, BLUE])
        self.browser.key(END, *[LEFT] * 5)
        self.assertEqual(self.split(), 95)
        self.assertEqual(self.drawn((0.3, 0.2), (0.7, 0.2)), [RED, RED])
        self.assertEqual(self.browser.run("return document.activeElement.getAttribute('aria-valuetext')"), "95 % red")

    def test_switches_pictures_by_key(self):
        self.browser.key("2")
        self.assertEqual(self.drawn((0.3, 0.2), (0.7, 0.2)), [RED, RED])
        self.browser.key("1")
        self.assertEqual(self.drawn((0.3, 0.2), (0.7, 0.2)), [BLUE, BLUE])
        self.browser.key(SPACE)
        self.assertEqual(self.drawn((0.3, 0.2)), [RED])
        self.browser.mouse(self.stage_point(0.5, 0.5))
        self.assertEqual(self.drawn((0.3, 0.2)), [BLUE])
        self.browser.key("s", SPACE)
        self.assertEqual(self.drawn((0.3, 0.2), (0.7, 0.2)), [RED, BLUE])
        self.browser.key("9")
        self.assertEqual(self.drawn((0.3, 0.2), (0.7, 0.2)), [RED, BLUE])

    def test_switches_pictures_by_lists_and_buttons(self):
        self.browser.run("const list = document.querySelector('#left'); list.value = 2; list.dispatchEvent(new Event('change'))")
        self.assertEqual(self.drawn((0.3, 0.2), (0.7, 0.2)), [BLUE, BLUE])
        self.assertEqual(self.texts(".show[data-side] .badge"), ["right", "left"])
        self.click("#pictures li:nth-child(2) button")
        self.assertEqual(self.drawn((0.7, 0.2)), [RED])
        self.browser.key(SPACE)  # which the button must not have kept
        self.assertEqual(self.drawn((0.7, 0.2)), [BLUE])
        self.click("#swap")
        self.click("#mode-slider")
        self.assertEqual(self.drawn((0.3, 0.2), (0.7, 0.2)), [RED, BLUE])
        self.assertEqual(self.browser.run("return document.querySelector('#canvas').getAttribute('aria-label')"), "Left: red. Right: equal.")

    def test_zooms_crisply_and_pans(self):
        for _ in range(12):
            self.browser.key("+")
        self.assertGreater(self.zoom(), 6000)
        self.browser.run("setSplit(0)")
        stripes = set(self.drawn(*[(x / 40, 0.45) for x in range(14, 27)]))
        self.assertEqual(stripes, {BLACK, WHITE})
        before = self.browser.screenshot()
        self.browser.mouse(self.stage_point(0.5, 0.3), self.stage_point(0.55, 0.32))
        after = self.browser.screenshot()
        self.assertNotEqual(before, after)
        self.browser.key((SHIFT, LEFT), (SHIFT, LEFT), (SHIFT, LEFT), (SHIFT, LEFT), (SHIFT, LEFT))
        self.assertEqual(self.drawn((0.5, 0.2)), [BLUE])
        self.assertRegex(self.text("#where"), r"^\d+, \d+$")
        self.assertEqual(self.split(), 0)

    def test_the_wheel_keeps_the_pixel_under_the_mouse(self):
        x, y = self.stage_point(0.48, 0.6)
        self.browser.hover(x, y)
        self.browser.wait("document.querySelector('#where').textContent !== '–'", "the read-out")
        where = self.text("#where")
        for _ in range(4):
            self.browser.wheel(x, y, -120)
        self.assertEqual(self.text("#where"), where)
        # At the smallest scale the wheel belongs to the page again.
        self.browser.key("0")
        for _ in range(8):
            self.browser.wheel(x, y, 3000)
        self.browser.wait("scrollY > 0", "the page to scroll")

    def test_reads_pixels(self):
        self.browser.hover(*self.stage_point(0.5, 0.02))
        self.browser.wait("document.querySelector('#where').textContent.endsWith(', 0')", "the read-out")
        self.assertEqual(self.text("#rgb-left").split(), ["200", "30", "20"])
        self.assertEqual(self.text("#rgb-right").split(), ["20", "40", "200"])
        self.browser.key("4")  # the error map of red: 0.5 everywhere
        self.browser.hover(*self.stage_point(0.5, 0.04))
        self.browser.wait("document.querySelector('#name-left').textContent === 'FLIP: red'", "the error map")
        self.assertAlmostEqual(float(self.text("#rgb-left")), 0.5, delta=0.01)
        self.browser.key("5")
        self.browser.hover(*self.stage_point(0.5, 0.02))
        self.assertEqual(self.text("#rgb-left"), "0.000")

    def test_the_tables(self):
        self.assertEqual(self.texts("#metrics tbody th"), ["red", "equal"])
        self.assertEqual(self.texts("#metrics tbody td"), ["12.35 dB", "0.7500", "0.2500", "0.1250", "6.25 %", "∞", "1.0000", "0.0000", "0.0000", "0.00 %"])
        self.assertEqual(self.texts("#made tbody th"), ["time", "memory", "rays"])
        self.assertEqual(self.texts("#made tbody td"), ["9 s", "1 s", "–", "–", "2 MiB", "–", "–", "–", "7"])
        self.assertEqual(self.text("h1"), "Ünïcode </script><script>fail()</script> & \"quotes\" {{title}}")
        self.assertEqual(self.texts(".notes li"), ["A note with <i>no</i> markup.", "A second note."])

    def test_copies_a_command(self):
        self.browser.cdp("Browser.grantPermissions", permissions=["clipboardReadWrite", "clipboardSanitizedWrite"])
        for refuse in ("", "navigator.clipboard.writeText = () => Promise.reject();"):
            self.browser.run(refuse + "window.copied = ''; addEventListener('copy', () => { copied = getSelection().toString() || document.activeElement.value; })")
            self.browser.run("document.querySelectorAll('.copy')[1].scrollIntoView({block: 'center'})")
            self.click(".commands li:nth-child(2) .copy")
            self.browser.wait("document.querySelectorAll('.copy')[1].textContent === 'Copied'", "the copy")
            if refuse:
                self.assertEqual(self.browser.run("return copied"), "sample --tracer 'red' <&>")
            self.browser.wait("document.querySelectorAll('.copy')[1].textContent === 'Copy'", "the button")
        self.assertEqual(self.texts(".command code"), ["sample --tracer reference", "sample --tracer 'red' <&>", "sample all"])

    def test_a_phone(self):
        self.browser.phone()
        self.open()
        self.assertEqual(self.browser.run("return [innerWidth, devicePixelRatio]"), [390, 2])
        self.assertEqual(self.drawn((0.3, 0.2), (0.7, 0.2)), [RED, BLUE])
        path = [[self.stage_point(x, 0.5)] for x in (0.5, 0.6, 0.7, 0.85)]
        self.browser.touch(*path)
        self.assertEqual(self.split(), 85)
        self.assertEqual(self.drawn((0.3, 0.2), (0.7, 0.2)), [RED, RED])
        fitted = self.zoom()
        apart = lambda d: [self.stage_point(0.5 - d, 0.5), self.stage_point(0.5 + d, 0.5)]
        self.browser.touch(apart(0.1), apart(0.2), apart(0.3), apart(0.4))
        self.browser.wait(f"parseFloat(document.querySelector('#zoom').textContent) > {2 * fitted}", "the pinch")
        self.assertEqual(self.split(), 85)
        # Now a finger moves the picture, and the page behind it stays.
        top = self.browser.run("return state.y")
        self.browser.touch(*[[self.stage_point(0.3, y)] for y in (0.8, 0.6, 0.4, 0.2)])
        self.assertGreater(self.browser.run("return state.y"), top)
        self.assertEqual(self.browser.run("return scrollY"), 0)
        small = self.browser.run("return [...document.querySelectorAll('.bar button, .bar select, .copy')].filter(b => b.getBoundingClientRect().height < 40).length")
        self.assertEqual(small, 0, "buttons too small for a finger")

    def test_both_colour_schemes(self):
        backgrounds = []
        for scheme in ("light", "dark"):
            self.browser.media("", scheme)
            backgrounds.append(sum(Picture(self.browser.screenshot()).at(2, 2)))
        self.assertGreater(backgrounds[0], 600)
        self.assertLess(backgrounds[1], 150)

    def test_on_paper(self):
        self.browser.media("print")
        self.assertEqual(self.box("#stage")["height"], 0)
        boxes = self.browser.run("return [...document.querySelectorAll('#pictures img')].map(i => i.getBoundingClientRect().toJSON())")
        for above, below in zip(boxes, boxes[1:]):
            self.assertGreaterEqual(below["y"], above["bottom"])
        self.assertEqual({(box["width"], box["height"]) for box in boxes}, {(60, 40)})
        self.assertGreater(self.box("#metrics")["height"], 0)

    def test_without_javascript(self):
        self.browser.cdp("Emulation.setScriptExecutionDisabled", value=True)
        try:
            self.browser.open(self.report)
            self.assertEqual(self.texts("figcaption"), ["reference", "red", "equal", "FLIP: red", "FLIP: equal"])
            for selector in ("#stage", ".bar", ".readout", ".copy", ".help"):
                self.assertEqual(self.box(selector)["height"], 0, selector)
            self.assertEqual(self.box("#pictures li:nth-child(2) img")["width"], 60)
            self.assertGreater(self.box("#metrics")["height"], 0)
        finally:
            self.browser.cdp("Emulation.setScriptExecutionDisabled", value=False)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    source = parser.add_mutually_exclusive_group(required=True)
    source.add_argument("--sample", metavar="PROGRAM", help="sample_report")
    source.add_argument("--report", metavar="FILE", help="any report")
    parser.add_argument("tests", nargs="*", help="only these, as Sample.test_reads_pixels")
    arguments = parser.parse_args()

    lacking = browsers.missing()
    if lacking:
        needed = os.environ.get("PEELRAY_REQUIRE_BROWSER") == "1"
        print(f"report_browser_test: {'failed' if needed else 'skipped'}, no {lacking} here (apt-get install chromium chromium-driver)")
        return 1 if needed else 77
    with tempfile.TemporaryDirectory() as folder:
        Page.report = arguments.report or os.path.join(folder, "a report.html")
        if arguments.sample:
            subprocess.run([arguments.sample, Page.report], check=True)
        classes = [AnyReport, Sample] if arguments.sample else [AnyReport]
        load = unittest.defaultTestLoader
        suite = load.loadTestsFromNames(arguments.tests, sys.modules[__name__]) if arguments.tests else unittest.TestSuite(map(load.loadTestsFromTestCase, classes))
        return 0 if unittest.TextTestRunner(verbosity=2).run(suite).wasSuccessful() else 1


if __name__ == "__main__":
    sys.exit(main())
