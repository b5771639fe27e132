"""Pictures that turn, in a browser without a window: turning_page.py ADAMAS. Ends with 77 where there is no browser."""

import html
import os
import re
import shutil
import subprocess
import sys
import tempfile

BROWSERS = ("chromium-headless-shell", "chromium", "chromium-browser", "google-chrome")
EVIL = "</script><b id=evil>"


def run(*command):
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)


def body_of(browser, page, folder):
    """The attributes of the body after the page has drawn, and all of its text."""
    found = subprocess.run(
        [browser, "--headless", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-dev-shm-usage",
         "--host-resolver-rules=MAP * ~NOTFOUND", f"--user-data-dir={folder}/profile", "--window-size=900,600",
         "--virtual-time-budget=20000", "--dump-dom", "file://" + page],
        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, timeout=240, check=True, text=True).stdout
    attributes = dict(re.findall(r'data-([\w-]+)="([^"]*)"', re.search(r"<body([^>]*)>", found).group(1)))
    return attributes, found


def acted(page, script):
    """A copy of a page in which a script acts once the page has drawn."""
    with open(page, encoding="utf-8") as file:
        text = file.read()
    copy = page.replace(".html", "-acted.html")
    with open(copy, "w", encoding="utf-8") as file:
        file.write(text.replace("</body>", f"<script>{script}</script></body>"))
    return copy


def expect(holds, what):
    if not holds:
        sys.exit(f"turning_page: {what}")


def main():
    adamas = sys.argv[1]
    browser = next((b for b in map(shutil.which, BROWSERS) if b), None)
    if browser is None:
        print("turning_page: no browser")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as folder:
        data, page = os.path.join(folder, "cells.vtr"), os.path.join(folder, "turn.html")
        run(adamas, "generate", "scene", "voronoi10", "--dimensions", "12,12,12", "-q", "-o", data)
        run(adamas, "reconstruct", data, "-q", "-o", os.path.join(folder, "i.vtp"), "--picture", page)
        with open(page, encoding="utf-8") as file:
            text = file.read()
        expect(not re.search(r'(src|href)="http', text), "expected no outside references")

        state, shown = body_of(browser, page, folder)
        expect(state.get("state") == "drawn", f"expected a picture, found {state}")
        everything = int(state["triangles"])
        expect(everything > 1000, f"expected triangles, found {everything}")
        expect(len(re.findall('class="swatch"', shown)) == 10, "expected ten materials")

        # A click hides a material, and a second click shows it again.
        click = "document.querySelectorAll('#materials input')[3].click();"
        fewer = int(body_of(browser, acted(page, click), folder)[0]["triangles"])
        expect(0 < fewer < everything, f"expected fewer triangles than {everything}, found {fewer}")
        again = int(body_of(browser, acted(page, click + click), folder)[0]["triangles"])
        expect(again == everything, f"expected {everything} triangles again, found {again}")
        # Clicks on all materials hide all triangles.
        all_hidden = "document.querySelectorAll('#materials input').forEach(function (i) { i.click(); });"
        none = int(body_of(browser, acted(page, all_hidden), folder)[0]["triangles"])
        expect(none == 0, f"expected no triangle, found {none}")

        # On a cut a resampled mesh shows materials, or any of its fields.
        run(adamas, "resample", data, "--interface-error", "3%", "--ghost", "linear", "-q", "--picture", os.path.join(folder, "cut.html"))
        cut = os.path.join(folder, "cut.html")
        expect(body_of(browser, cut, folder)[0].get("state") == "drawn", "expected a picture of a mesh")

        def cut_at(place, field, more=""):
            script = (f"var f = document.getElementById('cut-field'); f.value = '{field}'; document.getElementById('clip-place').value = {place};"
                      f"var a = document.getElementById('clip-axis'); a.value = 'x'; a.dispatchEvent(new Event('change')); {more}"
                      "document.body.dataset.picture = document.querySelector('#view canvas').toDataURL().length + ' ' + "
                      "document.querySelector('#view canvas').toDataURL().slice(-4000);")
            found = body_of(browser, acted(cut, script), folder)[0]
            expect(found.get("cut") == "x " + field, f"expected a cut with {field}, found {found.get('cut')}")
            return found["picture"]

        pictures = [cut_at(300, "materials"), cut_at(300, "smooth"), cut_at(310, "smooth"), cut_at(300, "materials", all_hidden)]
        expect(len(set(pictures)) == 4, "expected cuts that differ by what they show")

        # Names are shown as text, not as markup.
        evil = text.replace('"name":"cell0"', '"name":"' + EVIL.replace("<", "\\u003c").replace(">", "\\u003e") + '"')
        with open(page, "w", encoding="utf-8") as file:
            file.write(evil)
        state, shown = body_of(browser, page, folder)
        expect(state.get("state") == "drawn" and html.escape(EVIL) in shown, "expected a name as text")
        expect('<b id="evil">' not in shown, "a name became an element")
    print("turning_page: drawn, hidden, shown again")


main()
