# SPDX-License-Identifier: BSD-3-Clause
"""The live page in a real browser during a run whose camera goes off: walls, robot and markers are drawn, and the words
say why it knows less. With the token it commands.

usage: live_page_test.py URL TOKEN [SCREENSHOT]   (the run is started by tests/process/stack_test.sh)
"""

import sys
import time
import urllib.error
import urllib.request

from browser import Browser, missing

# How many pixels of the map have each of the page's own colours, its shades being of walls.
COUNT_PIXELS = """
const canvas = document.getElementById("map");
const data = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
const style = getComputedStyle(document.documentElement), counts = {};
for (const name of arguments[0]) {
  const [r, g, b] = [1, 3, 5].map(i => parseInt(style.getPropertyValue("--" + name).trim().slice(i, i + 2), 16));
  counts[name] = 0;
  for (let i = 0; i < data.length; i += 4)
    if (Math.abs(data[i] - r) + Math.abs(data[i + 1] - g) + Math.abs(data[i + 2] - b) < 12) ++counts[name];
}
return counts;
"""


def wait_for_server(url, timeout_s=60):
    end = time.monotonic() + timeout_s
    while True:
        try:
            return urllib.request.urlopen(url + "view", timeout=5).read()
        except (urllib.error.URLError, OSError):
            if time.monotonic() > end:
                sys.exit(f"FAILED: nothing answers at {url}")
            time.sleep(0.2)


def expect(holds, what):
    print(("ok: " if holds else "FAILED: ") + what, flush=True)
    if not holds:
        sys.exit(1)


def set_pose(browser, url, token):
    """The robot is dragged to where it is already, looking along the corridor."""
    browser.open("about:blank")  # another fragment alone would not load the page again
    browser.open(f"{url}#token={token}")
    browser.wait_for(lambda: browser.run("return Boolean(view?.estimate && box)"))
    browser.click("set-pose")
    x, y = browser.run(
        "const r = canvas.getBoundingClientRect(), [x, y] = toPixel(...view.estimate.pose); return [r.left + x, r.top + y];"
    )
    browser.drag((x, y), (x + 60, y))
    browser.wait_for(lambda: browser.text("answer") not in ("", "Waiting for slam."))
    answer = browser.text("answer")
    expect(browser.run("return document.getElementById('answer').className") == "", f"slam takes the pose that was drawn: {answer}")


def main():
    if missing():
        print(f"skipped: no {' and no '.join(missing())} here; apt-get install chromium chromium-driver")
        sys.exit(77)
    url = sys.argv[1]
    wait_for_server(url)
    with Browser() as browser:
        browser.open(url)

        def seen():
            counts = browser.run(COUNT_PIXELS, ["wall", "free", "marker", "good", "warn", "bad"])
            counts["robot"] = max(counts["good"], counts["warn"], counts["bad"])
            return counts

        def is_drawn():
            counts = seen()
            return counts if min(counts[name] for name in ("wall", "marker", "robot")) > 40 and counts["free"] > 5000 else None

        counts = browser.wait_for(is_drawn)
        expect(True, f"walls, robot and markers are drawn: {counts}")
        expect(browser.text("health") in ("tracking", "degenerate"), f"health is {browser.text('health')}")
        before = browser.text("reason")
        expect("silent" not in before, f"the camera is not silent yet: {before}")
        expect(browser.run("return document.getElementById('unlocked').hidden"), "without the token there are no commands")
        set_pose(browser, url, sys.argv[2])
        browser.open("about:blank")
        browser.open(f"{url}#token=base64+with/and%2B=")
        expect(browser.run("return token") == "base64+with/and+=", "a token keeps its plus signs")
        browser.open("about:blank")
        browser.open(f"{url}#token={sys.argv[2]}")
        if len(sys.argv) > 3:
            browser.wait_for(lambda: browser.run("return view.markers.length >= 4"))
            browser.screenshot(sys.argv[3])
        browser.wait_for(lambda: "The camera has been silent for" in browser.text("reason"))
        expect(True, f"then it is: {browser.text('reason')}")
        width = browser.run("return document.documentElement.scrollWidth - window.innerWidth")
        expect(width <= 0, "nothing is wider than the window")
        errors = browser.run("return performance.getEntriesByType('resource').filter(e => !e.name.startsWith(location.origin)).length")
        expect(errors == 0, "nothing is loaded from elsewhere")


if __name__ == "__main__":
    main()
