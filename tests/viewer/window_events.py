"""The window of `adamas view`, with a real mouse and keys: on a screen that is none, by Xvfb and xdotool.

Usage: window_events.py ADAMAS. Exits with 77 where there is no Xvfb or xdotool."""

import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time

SKIPPED = 77


def wait_for(what, fails, seconds=120):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if what():
            return
        time.sleep(0.1)
    sys.exit(f"window: {fails}")


class Screen:
    """A screen without a device."""

    def __init__(self):
        read, write = os.pipe()
        # Without -noreset the server begins anew when its last client leaves, and refuses a client that comes meanwhile.
        self.process = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write), "-screen", "0", "1000x700x24", "-nolisten", "tcp", "-noreset"],
            pass_fds=[write], stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as number:
            self.display = ":" + number.readline().strip()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()


class Window:
    """The program on that screen, in a folder of its own."""

    def __init__(self, adamas, screen, folder, *arguments):
        self.folder = folder
        self.environment = {**os.environ, "DISPLAY": screen.display, "XDG_STATE_HOME": os.path.join(folder, "state"), "LIBGL_ALWAYS_SOFTWARE": "1"}
        self.process = subprocess.Popen([adamas, "view", *arguments, "--size", "900,600"], cwd=folder, env=self.environment,
                                        stderr=subprocess.PIPE, text=True)
        wait_for(lambda: self.process.poll() is not None or self.do("search", "--name", "adamas", fails=False), "no window came")

    def do(self, *arguments, fails=True):
        found = subprocess.run(["xdotool", *arguments], env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=False)
        if fails and found.returncode != 0:
            sys.exit(f"window: xdotool {' '.join(arguments)} failed")
        return found.returncode == 0

    def pictures(self):
        return sorted(name for name in os.listdir(self.folder) if name.startswith("adamas-") and name.endswith(".png"))

    def screenshot(self):
        """The picture after all that was done before: keys are answered in their order."""
        before = len(self.pictures())
        for _ in range(12):
            # A window that has just appeared may not take input yet.
            self.do("key", "F12")
            end = time.monotonic() + 10
            while time.monotonic() < end and self.process.poll() is None:
                if len(self.pictures()) > before:
                    with open(os.path.join(self.folder, self.pictures()[-1]), "rb") as file:
                        return file.read()
                time.sleep(0.05)
        if self.process.poll() is not None:
            sys.exit(f"window: it ended: {self.process.stderr.read()}")
        return sys.exit(f"window: no screenshot after {before} others")

    def settled(self):
        """Screenshots until two are the same."""
        last = self.screenshot()
        for _ in range(60):
            now = self.screenshot()
            if now == last:
                return now
            last = now
        return sys.exit("window: the picture does not settle")

    def drag(self, button, x, y, to_x, to_y):
        self.do("mousemove", str(x), str(y))
        time.sleep(0.2)
        self.do("mousedown", str(button))
        for n in range(1, 5):
            time.sleep(0.1)
            self.do("mousemove", str(x + (to_x - x) * n // 4), str(y + (to_y - y) * n // 4))
        time.sleep(0.2)
        self.do("mouseup", str(button))

    def interrupt(self):
        """One signal ends it, as Ctrl-C in a terminal."""
        self.process.send_signal(signal.SIGINT)
        wait_for(lambda: self.process.poll() is not None, "SIGINT does not end it", seconds=20)
        check(self.process.returncode == 130, f"SIGINT ends it with {self.process.returncode}")

    def end(self):
        self.do("key", "Escape")
        wait_for(lambda: self.process.poll() is not None, "Escape does not end it")
        error = self.process.stderr.read()
        if self.process.returncode != 0:
            sys.exit(f"window: it ended with {self.process.returncode}: {error}")


def check(holds, what):
    if not holds:
        sys.exit(f"window: {what}")


def try_mouse_and_keys(window):
    first = window.settled()
    window.drag(1, 600, 300, 660, 330)
    turned = window.settled()
    check(turned != first, "the left button turns nothing")
    window.do("mousemove", "600", "300", "click", "4", "click", "4")
    zoomed = window.settled()
    check(zoomed != turned, "the wheel zooms nothing")
    window.do("key", "e")
    check(window.settled() != zoomed, "E shows no edges")
    window.do("key", "p")
    window.do("key", "9")
    window.do("key", "5")
    window.settled()


STEPS = 5


def write_steps(folder):
    """A ball that becomes smaller from step to step."""
    names = []
    for step in range(STEPS):
        names.append(f"s{step}.raw")
        middle, side = 12, range(25)
        squares = ((i - middle) ** 2 + (j - middle) ** 2 + (k - middle) ** 2 for k in side for j in side for i in side)
        with open(os.path.join(folder, names[-1]), "wb") as file:
            file.write(bytes(max(0, int(200 - 12 * square ** 0.5 - 20 * step)) for square in squares))
    return names


def try_steps(window):
    first = window.settled()
    window.do("key", "End")
    last = window.settled()
    check(last != first, "End shows no other step")
    window.do("key", "Home")
    check(window.settled() == first, "the first step is not as it was")
    window.do("key", "space")
    wait_for(lambda: window.screenshot() not in (first, last), "the space bar plays nothing")
    window.do("key", "space")
    window.settled()
    window.do("key", "Home")
    window.do("key", "period")
    second = window.settled()
    check(second not in (first, last), "the second step is none")
    window.do("key", "comma")
    check(window.settled() == first, "there is no way back")
    window.do("key", "period")


def try_exports(window, folder):
    """The view stays as it is, and what is there is left alone."""
    before = window.settled()
    with open(os.path.join(folder, "steps-images-001"), "w", encoding="utf-8") as file:
        file.write("mine")
    window.do("key", "i")
    images = os.path.join(folder, "steps-images-002")
    wait_for(lambda: os.path.exists(images), "I writes no images")
    names = [f"frame{n + 1:04}.png" for n in range(STEPS)]
    check(sorted(os.listdir(images)) == names, "the images are not those of the steps")
    contents = {open(os.path.join(images, name), "rb").read() for name in names}
    check(len(contents) == STEPS, "images of different steps are the same")
    check(window.settled() == before, "the view is not as it was after an export")
    check(before in contents, "the image of the step that is seen is not what is seen")
    # Escape stops the export and ends nothing else.
    window.do("key", "--delay", "0", "f", "Escape")
    check(window.settled() == before, "the window is gone after an export was stopped")
    if shutil.which("ffmpeg"):
        window.do("key", "f")
        wait_for(lambda: any(name.startswith("steps-film-") for name in os.listdir(folder)), "F writes no film")
    check(not any(name.startswith(".partial-") for name in os.listdir(folder)), "an export has left a part")


def run_series(adamas_in_folder, open_window, folder):
    adamas_in_folder("store", *write_steps(folder), "--dimensions", "25", "--type", "uint8", "-o", "steps.adm")
    window = open_window("steps.adm", "--isovalue", "80")
    try_steps(window)
    try_exports(window, folder)
    window.end()
    with open(os.path.join(folder, "state", "adamas", "view.json"), encoding="utf-8") as file:
        state = json.load(file)[0]["state"]
    check(state["documents"][0].get("step") == 1, "the step is not remembered")
    check(state["pace"]["repeat"] == "loop", "how steps are played is not remembered")


def run(adamas):
    with tempfile.TemporaryDirectory() as folder, Screen() as screen:
        def adamas_in_folder(*arguments):
            subprocess.run([adamas, *arguments, "-q"], cwd=folder, check=True)

        adamas_in_folder("generate", "buckyball", "--dimensions", "32", "-o", "ball.vti")
        adamas_in_folder("store", "ball.vti", "-o", "ball.adm")
        window = Window(adamas, screen, folder, "ball.adm", "--isovalue", "80")
        try_mouse_and_keys(window)
        window.end()
        with open(os.path.join(folder, "state", "adamas", "view.json"), encoding="utf-8") as file:
            state = json.load(file)[0]["state"]
        check(state["edges"] and state["cut"]["on"], "what the keys did is not remembered")
        check(state["viewpoint"]["height"] > 0, "the projection is not remembered")
        window = Window(adamas, screen, folder, "ball.adm")
        window.settled()
        window.do("key", "e")
        window.settled()
        window.interrupt()
        with open(os.path.join(folder, "state", "adamas", "view.json"), encoding="utf-8") as file:
            check(not json.load(file)[0]["state"]["edges"], "the view is not remembered after a signal")
        # The program goes on from the last view, and it reports damage instead of dying of it.
        window = Window(adamas, screen, folder, "ball.adm")
        window.settled()
        os.truncate(os.path.join(folder, "ball.adm"), 300)
        window.do("key", "3")
        window.do("key", "e")
        window.settled()
        window.end()
        run_series(adamas_in_folder, lambda *arguments: Window(adamas, screen, folder, *arguments), folder)


def main():
    if not (shutil.which("Xvfb") and shutil.which("xdotool")):
        print("window: no Xvfb or xdotool")
        return SKIPPED
    run(os.path.abspath(sys.argv[1]))
    return 0


if __name__ == "__main__":
    sys.exit(main())
