#!/usr/bin/python3
"""Compares how models' materials look with what three.js shows of the same glTF files.

usage: compare.py BIN --three FOLDER [--keep FOLDER] [MODEL.gltf ...]

BIN: the folder of espalier-bake and espalier-capture. FOLDER of --three: node_modules/three, as `npm install three` leaves it.
Beside the models that are named, spheres of plastic, metal, glass and of materials that shine are compared. Needs Debian's
chromium, python3-pil and python3-numpy; without them, or without three.js, it says so and exits with 77, which CTest takes for
skipped. It exits with 1 where the mean colour of a model's tiles is further from three.js's than kFar.
"""
import argparse
import base64
import functools
import http.server
import io
import json
import os
import pathlib
import queue
import shutil
import subprocess
import sys
import tempfile
import threading
import urllib.parse

try:
    import numpy
    from PIL import Image
except ImportError as missing:
    print(f"compare.py: skipped: {missing}; apt-get install python3-pil python3-numpy")
    sys.exit(77)

import models

WIDTH, HEIGHT = 640, 480
TILE = 20        # pixels: what is compared are means of such squares, as edges and the grain of stone differ
kFar = 22        # of 255: the mean over all tiles of how far their colours are apart
FOV = 40
LIGHT = {"direction": [0.45, 0.62, 0.64], "sun": [2.9, 2.5, 1.95], "sky": [0.72, 0.84, 1.02], "ground": [0.44, 0.39, 0.28],
         "background": [0.17, 0.36, 0.72], "horizon": [0.66, 0.77, 0.88]}


def run(command):
    ran = subprocess.run([str(c) for c in command], capture_output=True, text=True, timeout=300)
    if ran.returncode != 0:
        sys.exit(f"compare.py: {' '.join(map(str, command))}: {ran.stderr or ran.stdout}")
    return ran.stdout


def view(surface):
    """A camera that shows all of a baked surface, from the front right and above."""
    low, high = models.bounds(surface)
    middle, reach = (low + high) / 2, float(numpy.linalg.norm(high - low)) / 2
    towards = numpy.array([0.55, 0.35, 1.0])
    eye = middle + towards / numpy.linalg.norm(towards) * reach * 2.6
    return {"eye": [float(v) for v in eye], "target": [float(v) for v in middle], "fov": FOV}


def ours(tools, model, work):
    surface = work / "model.surface.glb"
    run([tools / "espalier-bake", "-q", "--resolution", "256", model, "-o", surface])
    camera = view(surface)
    scene = {"surface": str(surface), "camera": camera, "grammars": [{"file": str(tools.resolve().parent / "content/grammars/ivy_free.grammar")}],
             "sun": {"direction": LIGHT["direction"], "colour": LIGHT["sun"], "intensity": 1},
             "sky": {"colour": LIGHT["sky"], "ground": LIGHT["ground"], "background": LIGHT["background"], "horizon": LIGHT["horizon"]}}
    (work / "scene.json").write_text(json.dumps(scene))
    run([tools / "espalier-capture", work / "scene.json", "--smooth", "4", "--size", f"{WIDTH}x{HEIGHT}", "-o", work / "frames"])
    return camera, Image.open(work / "frames/frame_0000.png").convert("RGB")


class Server:
    """The page, three.js and one model's folder, for a browser that reads modules from servers only."""

    def __init__(self, three):
        self.folders = {"three": three, "page": pathlib.Path(__file__).parent}
        self.answers = queue.Queue()   # what the page has drawn
        outer = self

        class Handler(http.server.SimpleHTTPRequestHandler):
            extensions_map = {**http.server.SimpleHTTPRequestHandler.extensions_map, ".js": "text/javascript"}

            def translate_path(self, path):
                parts = urllib.parse.unquote(urllib.parse.urlsplit(path).path).strip("/").split("/", 1)
                folder = outer.folders.get(parts[0], pathlib.Path("/nonexistent"))
                return str(folder / parts[1]) if len(parts) > 1 and ".." not in parts[1] else "/nonexistent"

            def do_POST(self):
                outer.answers.put(json.loads(self.rfile.read(int(self.headers["Content-Length"]))))
                self.send_response(204)
                self.end_headers()

            def log_message(self, *_):
                pass

        self.http = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        threading.Thread(target=self.http.serve_forever, daemon=True).start()

    def address(self, path):
        return f"http://127.0.0.1:{self.http.server_port}/{path}"


def theirs(server, browser, model, camera, work):
    server.folders["model"] = model.parent
    wanted = {**camera, "width": WIDTH, "height": HEIGHT, "light": LIGHT, "model": "/model/" + urllib.parse.quote(model.name)}
    page = server.address("page/page.html") + "#" + urllib.parse.quote(json.dumps(wanted))
    shown = subprocess.Popen([browser, "--headless", "--no-sandbox", "--disable-gpu-sandbox", "--use-gl=angle",
                              "--use-angle=swiftshader", "--enable-unsafe-swiftshader", f"--user-data-dir={work}/browser",
                              "--remote-debugging-port=0", page], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        answer = server.answers.get(timeout=300)
    except queue.Empty:
        answer = {"error": "it didn't answer within five minutes"}
    finally:
        shown.terminate()
        shown.wait()
    if "error" in answer:
        sys.exit(f"compare.py: three.js didn't draw {model}: {answer['error']}")
    picture, inside = (Image.open(io.BytesIO(base64.b64decode(answer[name]))) for name in ("picture", "inside"))
    picture.putalpha(inside.convert("RGBA").getchannel("A"))
    return picture


def difference(mine, other):
    """The mean over all tiles that the model fills; the tiles' own, for a picture."""
    a = numpy.asarray(mine).astype(float)
    b = numpy.asarray(other).astype(float)
    inside = b[..., 3] == 255
    apart = []
    for y in range(0, HEIGHT, TILE):
        for x in range(0, WIDTH, TILE):
            mask = inside[y:y + TILE, x:x + TILE]
            if mask.mean() < 0.9:
                continue
            means = [p[y:y + TILE, x:x + TILE, :3][mask].mean(axis=0) for p in (a, b)]
            apart.append(numpy.abs(means[0] - means[1]).max())
    return float(numpy.mean(apart)) if apart else 0.0, float(numpy.max(apart)) if apart else 0.0


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("--three", type=pathlib.Path, required=True)
    parser.add_argument("--keep", type=pathlib.Path)
    parser.add_argument("models", type=pathlib.Path, nargs="*")
    asked = parser.parse_intermixed_args()
    browser = shutil.which("chromium") or shutil.which("google-chrome")
    if not browser or not (asked.three / "build/three.module.js").exists():
        print(f"compare.py: skipped: there is no {'three.js in ' + str(asked.three) if browser else 'chromium'}")
        return 77
    server, failed = Server(asked.three.resolve()), False
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        for model in [*models.spheres(work), *asked.models]:
            camera, mine = ours(asked.bin, model.resolve(), work)
            other = theirs(server, browser, model.resolve(), camera, work)
            mean, most = difference(mine, other)
            print(f"{'ok  ' if mean <= kFar else 'FAIL'} {model.stem}: {mean:.1f} of 255 in the mean, {most:.0f} at most")
            failed |= mean > kFar
            if asked.keep:
                asked.keep.mkdir(parents=True, exist_ok=True)
                both = Image.new("RGB", (2 * WIDTH, HEIGHT))
                both.paste(mine, (0, 0))
                both.paste(other.convert("RGB"), (WIDTH, 0))
                both.save(asked.keep / f"{model.stem.replace(' ', '_')}.png")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
