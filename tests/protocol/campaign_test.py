#!/usr/bin/python3
"""`hilcam campaign` on a small scenario: the same bits however it is made, labels read by independent readers, kills, failures.

    campaign_test.py HILCAM SOURCE_DIR [CLASS...]
"""
import csv
import itertools
import json
import math
import os
import pathlib
import random
import runpy
import shutil
import signal
import subprocess
import sys
import tarfile
import tempfile
import time
import unittest

import numpy
import yaml
from PIL import Image

HILCAM, SOURCE = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
SCENARIO = SOURCE / "tests/protocol/minimal_scenario.yaml"
CAMPAIGN = f"""
name: test
scenario: {SCENARIO}
set: [objects.0.pose.attitude=quaternion, "camera.distortion=[-0.05, 0, 0.001]"]
count: 8
seed: 7
sequence: r_sequence
vary: [{{key: objects.0.pose.attitude_wxyz, attitude: true}}]
view:
  size_px: {{log_uniform: [60, 170]}}
  phase_deg: {{uniform: [0, 110]}}
  offset_share: {{uniform: [-0.4, 0.4]}}
  signal_dn: {{log_uniform: [400, 3000]}}
require: {{in_field: center, lit_share: 0.05, tries: 50}}
splits: [{{name: train, share: 0.6}}, {{name: val, share: 0.4}}]
labels: [coco, bop, yolo, speed]
keypoints: [{{file: points.csv, tolerance_m: 0.5}}]
shard_samples: 3
"""
CUBE = "".join(f"v {x} {y} {z}\n" for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)) + \
    "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n"
POINTS = {"origin": (0, 0, 0), "ahead": (1.5, 0, 0), "beside": (0, 6.0, 0.25), "far": (0, -300, 0)}


def campaign(text, folder, *options, expect=0, prefix=(), timeout=120):
    folder = pathlib.Path(folder)
    folder.parent.mkdir(parents=True, exist_ok=True)
    file = folder.parent / "campaign.yaml"
    file.write_text(text)
    (folder.parent / "points.csv").write_text("name,x_m,y_m,z_m\n" + "".join(f"{n},{x},{y},{z}\n" for n, (x, y, z) in POINTS.items()))
    result = subprocess.run([*prefix, HILCAM, "campaign", file, "--out", folder, *map(str, options)], capture_output=True, text=True, timeout=timeout)
    if expect is not None and result.returncode != expect:
        raise AssertionError(f"status {result.returncode}: {result.stderr}")
    return result


def rows(folder, name="index.csv"):
    with open(folder / name, newline="") as file:
        return list(csv.DictReader(file))


def record(folder, number):
    return json.loads((folder / f"cases/{number:06d}.json").read_text())


def contents(folder):
    """All files and their bytes, but for what tells of this making: times, and who holds the lock."""
    out = {}
    for path in sorted(folder.rglob("*")):
        name = str(path.relative_to(folder))
        if not path.is_file() or name in ("times.csv", "index.html", "campaign.lock"):
            continue
        out[name] = path.read_bytes()
        if name.startswith("cases/"):
            case = json.loads(out[name])
            del case["took"]
            out[name] = json.dumps(case)
    return out


def rotation(q):
    """p' = R(q) p, scalar first."""
    w, x, y, z = q
    return numpy.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def projected(points, matrix, distortion):
    """As OpenCV has it: places in camera axes to pixels."""
    k1, k2, p1, p2, k3 = distortion
    x, y = points[..., 0] / points[..., 2], points[..., 1] / points[..., 2]
    r2 = x * x + y * y
    radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3))
    xd = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)
    yd = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y
    return numpy.stack([matrix[0][0] * xd + matrix[0][2], matrix[1][1] * yd + matrix[1][2]], -1)


def unpacked(segmentation):
    """COCO's compressed run lengths, by the description in its maskApi.h and the text coding of maskApi.c."""
    height, width = segmentation["size"]
    text, counts, at = segmentation["counts"], [], 0
    while at < len(text):
        value = shift = 0
        while True:
            bits = ord(text[at]) - 48
            at += 1
            value |= (bits & 31) << shift
            shift += 5
            if not bits & 32:
                break
        if bits & 16:
            value -= 1 << shift
        counts.append(value + (counts[-2] if len(counts) > 2 else 0))
    assert sum(counts) == height * width
    return numpy.repeat(numpy.arange(len(counts)) % 2 == 1, counts).reshape(width, height).T


def box_of(mask):
    y, x = numpy.nonzero(mask)
    return [int(x.min()), int(y.min()), int(x.max() - x.min() + 1), int(y.max() - y.min() + 1)]


def ply(file):
    """Vertices [mm], normals and triangles of a PLY file in text, as the format's document has models."""
    lines = iter(file.read_text().splitlines())
    counts, names, element = {}, [], None
    assert next(lines) == "ply" and next(lines) == "format ascii 1.0"
    for line in lines:
        word, *rest = line.split()
        if word == "end_header":
            break
        if word == "element":
            element = rest[0]
            counts[element] = int(rest[1])
        elif word == "property" and element == "vertex":
            names.append(rest[-1])
    table = numpy.array([[float(v) for v in next(lines).split()] for _ in range(counts["vertex"])])
    faces = numpy.array([[int(v) for v in next(lines).split()] for _ in range(counts["face"])])
    assert next(lines, None) is None and (faces[:, 0] == 3).all()
    columns = [[names.index(n) for n in group] for group in (("x", "y", "z"), ("nx", "ny", "nz"))]
    return table[:, columns[0]], table[:, columns[1]], faces[:, 1:]


def check_model(test, vertices, normals, triangles, info):
    """models_info.json as scripts/calc_model_info.py of the toolkit counts it."""
    test.assertEqual(len(numpy.unique(triangles)), len(vertices))
    test.assertLess(numpy.abs(numpy.linalg.norm(normals, axis=1) - 1).max(), 1e-5)
    diameter = max(numpy.linalg.norm(vertices - v, axis=1).max() for v in vertices)
    for name, value in (("diameter", diameter), *((f"min_{a}", v) for a, v in zip("xyz", vertices.min(0))),
                        *((f"size_{a}", v) for a, v in zip("xyz", numpy.ptp(vertices, axis=0)))):
        test.assertLess(abs(info[name] - value), 1e-7 * diameter, name)


class Made(unittest.TestCase):
    """One campaign that all of these look at."""

    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.top = pathlib.Path(cls.temporary.name)
        cls.folder = cls.top / "first"
        campaign(CAMPAIGN, cls.folder, "--jobs", 2)
        cls.rows = rows(cls.folder)
        cls.names = {row["case"]: row for row in cls.rows}

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def test_every_case_has_its_row(self):
        self.assertEqual([row["case"] for row in self.rows], [f"{n:06d}" for n in range(1, 9)])
        self.assertEqual({row["outcome"] for row in self.rows}, {"done"})
        self.assertEqual(len({row["seed"] for row in self.rows}), 8)
        for row in self.rows:
            self.assertGreaterEqual(float(row["lit_share"]), 0.05)
            self.assertGreater(float(row["snr"]), 1)
        self.assertEqual([t["case"] for t in rows(self.folder, "times.csv")], [row["case"] for row in self.rows])

    def test_the_same_bits_whatever_makes_them(self):
        first = contents(self.folder)
        one = self.top / "one/out"
        campaign(CAMPAIGN, one, "--jobs", 1)
        self.assertEqual(contents(one), first)
        parts = self.top / "parts/out"
        for part in ("5-8", "1-2", "3-4"):
            campaign(CAMPAIGN, parts, "--cases", part)
        self.assertFalse((parts / "index.csv").exists())
        campaign(CAMPAIGN, parts, "--merge")
        self.assertEqual(contents(parts), first)
        # Two clusters that share nothing, with a case that both have made: their folders copied together are one campaign.
        clusters = [self.top / f"cluster_{n}/out" for n in (1, 2)]
        for cluster, part in zip(clusters, ("1-5", "5-8")):
            campaign(CAMPAIGN, cluster, "--cases", part)
        together = self.top / "together/out"
        for cluster in clusters:
            shutil.copytree(cluster, together, dirs_exist_ok=True)
        campaign(CAMPAIGN, together, "--merge")
        self.assertEqual(contents(together), first)

    def test_a_case_comes_again_alone_and_as_a_picture(self):
        alone = self.top / "alone/out"
        campaign(CAMPAIGN, alone, "--case", 5)
        for name in ("images/000005.png", "views/000005.png", "depth/000005.png"):
            self.assertEqual((alone / name).read_bytes(), (self.folder / name).read_bytes())
        sets = [word for value in record(self.folder, 5)["set"] for word in ("--set", value)]
        picture = self.top / "picture.png"
        subprocess.run([HILCAM, "render", SCENARIO, *sets, "--out", picture], check=True, capture_output=True)
        self.assertEqual(picture.read_bytes(), (self.folder / "images/000005.png").read_bytes())

    def test_the_manual_is_the_documented_one(self):
        table = subprocess.run([HILCAM, "manual", "--campaign"], capture_output=True, text=True, check=True).stdout
        self.assertIn(table, (SOURCE / "docs/campaigns.md").read_text())

    def test_the_page_shows_what_there_is(self):
        page = (self.folder / "index.html").read_text()
        for words in ("8 cases: 8 done, 0 failed", "No case has failed", "Phase angle", "Signal over noise", 'src="views/000003.png"', ">-180°<", ">-90°<"):
            self.assertIn(words, page)

    def test_numbers_of_the_page_are_written_as_people_write_them(self):
        number_text = runpy.run_path(str(SOURCE / "tools/hilcam-plot-campaign"))["number_text"]
        for value, words in ((56300, "56,300"), (0.01035, "0.01035"), (0, "0"), (-5.5, "-5.5"), (9999.6, "10,000"), (1e9, "1e+09")):
            self.assertEqual(number_text(value), words)

    def test_coco(self):
        seen = 0
        for split in ("train", "val"):
            coco = json.loads((self.folder / f"coco/{split}.json").read_text())
            images = {image["id"]: image for image in coco["images"]}
            self.assertEqual(coco["categories"][0]["keypoints"], list(POINTS))
            for label in coco["annotations"]:
                image = images[label["image_id"]]
                name = pathlib.Path(image["file_name"]).stem
                self.assertEqual(self.names[name]["split"], split)
                with Image.open(self.folder / image["file_name"]) as picture:
                    self.assertEqual(picture.size, (image["width"], image["height"]))
                mask = unpacked(label["segmentation"])
                self.assertEqual(mask.shape, (image["height"], image["width"]))
                self.assertEqual((int(mask.sum()), box_of(mask)), (label["area"], label["bbox"]))
                self.assertEqual(label["area"], int(self.names[name]["visible_px"]))
                self.check_keypoints(label, record(self.folder, int(name)))
                seen += 1
        self.assertEqual(seen, 8)

    def check_keypoints(self, label, case):
        truth = case["frames"][0]["truth"]
        image, target = truth["image"], truth["objects"][0]
        fx, fy = image["focal_length_px"]
        cx, cy = image["principal_point_px"]
        places = numpy.array(list(POINTS.values()), float) @ rotation(target["camera_from_body_wxyz"]).T + target["position_camera_m"]
        expected = projected(places, [[fx, 0, cx], [0, fy, cy], [0, 0, 1]], image["distortion"])
        found = numpy.array(label["keypoints"]).reshape(-1, 3)
        self.assertEqual(label["num_keypoints"], int((found[:, 2] > 0).sum()))
        for place, (x, y, visibility) in zip(expected, found):
            if visibility:
                self.assertLess(math.hypot(place[0] - x, place[1] - y), 1e-5)
            else:
                self.assertEqual((x, y), (0, 0))
        self.assertEqual(found[-1, 2], 0)  # 300 m beside the target

    def test_bop(self):
        for split in ("train", "val"):
            scene = self.folder / f"bop/{split}/000000"
            cameras, poses, infos = (json.loads((scene / f"scene_{n}.json").read_text()) for n in ("camera", "gt", "gt_info"))
            self.assertEqual(set(cameras), set(poses))
            for key, camera in cameras.items():
                case = record(self.folder, int(key) + 1)
                truth = case["frames"][0]["truth"]
                target = truth["objects"][0]
                stem = f"{int(key):06d}"
                self.assertEqual((scene / f"gray/{stem}.png").read_bytes(), (self.folder / f"views/{case['name']}.png").read_bytes())
                mask = numpy.array(Image.open(scene / f"mask_visib/{stem}_000000.png")) > 0
                whole = numpy.array(Image.open(scene / f"mask/{stem}_000000.png")) > 0
                info, pose = infos[key][0], poses[key][0]
                self.assertEqual((int(mask.sum()), box_of(mask)), (info["px_count_visib"], info["bbox_visib"]))
                self.assertEqual(info["visib_fract"], info["px_count_visib"] / info["px_count_all"])
                self.assertAlmostEqual(info["visib_fract"], target["visible_fraction"])
                # Nothing stands before the target.
                self.assertTrue((whole == mask).all())
                self.assertEqual(info["px_count_valid"], info["px_count_visib"])
                if not target["silhouette_cut"] and info["visib_fract"] == 1:
                    self.assertEqual(info["bbox_obj"], info["bbox_visib"])
                # The model's origin, by cam_K and the pose, is truth's centre without distortion, from the first pixel's middle.
                k = numpy.array(camera["cam_K"]).reshape(3, 3)
                place = k @ numpy.array(pose["cam_t_m2c"])
                x, y = place[:2] / place[2] + 0.5
                fx, fy = truth["image"]["focal_length_px"]
                cx, cy = truth["image"]["principal_point_px"]
                p = target["position_camera_m"]
                self.assertAlmostEqual(x, cx + fx * p[0] / p[2], 5)
                self.assertAlmostEqual(y, cy + fy * p[1] / p[2], 5)
                # World to camera to model: the target's place and attitude in the world.
                w2c, m2c = (numpy.array(v).reshape(3, 3) for v in (camera["cam_R_w2c"], pose["cam_R_m2c"]))
                world = w2c.T @ (numpy.array(pose["cam_t_m2c"]) - camera["cam_t_w2c"]) / 1000
                self.assertLess(numpy.abs(world - target["position_m"]).max(), 1e-6)
                self.assertLess(numpy.abs(w2c.T @ m2c - rotation(target["attitude_wxyz"])).max(), 1e-9)
                # Depth is near the origin's wherever the target is.
                depth = numpy.array(Image.open(scene / f"depth/{stem}.png")) * camera["depth_scale"] / 1000
                self.assertEqual((depth > 0).sum(), mask.sum())
                self.assertLess(numpy.abs(depth[mask] - p[2]).max(), target["radius_m"] + camera["depth_scale"] / 1000)

    def test_bop_model(self):
        vertices, normals, triangles = ply(self.folder / "bop/models/obj_000001.ply")
        info = json.loads((self.folder / "bop/models/models_info.json").read_text())
        self.assertEqual(list(info), ["1"])
        check_model(self, vertices, normals, triangles, info["1"])
        # The target of 20,000 triangles, whose truth tells the sphere about its origin that holds it.
        self.assertGreater(len(triangles), 15000)
        radius = record(self.folder, 1)["frames"][0]["truth"]["objects"][0]["radius_m"]
        self.assertAlmostEqual(numpy.linalg.norm(vertices, axis=1).max() / 1000, radius, 4)

    def test_yolo(self):
        data = yaml.safe_load((self.folder / "yolo/data.yaml").read_text())
        self.assertEqual((data["nc"], data["names"][0], data["kpt_shape"]), (1, "target", [4, 3]))
        for split in ("train", "val"):
            for text in (self.folder / f"yolo/labels/{split}").glob("*.txt"):
                self.assertTrue((self.folder / "yolo" / data[split] / f"{text.stem}.png").is_file())
                kind, x, y, w, h, *points = map(float, text.read_text().split())
                truth = record(self.folder, int(text.stem))["frames"][0]["truth"]
                width, height = truth["image"]["width_px"], truth["image"]["height_px"]
                left, top, across, down = truth["objects"][0]["visible_box_px"]
                for found, told in ((x * width, left + across / 2), (y * height, top + down / 2), (w * width, across), (h * height, down)):
                    self.assertAlmostEqual(found, told, 6)
                self.assertEqual(kind, 0)
                self.assertEqual(len(points), 12)

    def test_speed(self):
        """As the data set's own tools project: K (R(q) p + r)."""
        camera = json.loads((self.folder / "speed/camera.json").read_text())
        self.assertAlmostEqual(camera["fx"] / camera["ppx"], camera["cameraMatrix"][0][0], 6)
        count = 0
        for split in ("train", "val"):
            for label in json.loads((self.folder / f"speed/{split}.json").read_text()):
                self.assertTrue((self.folder / "speed/images" / label["filename"]).is_file())
                r = numpy.array(label["r_Vo2To_vbs_true"])
                places = rotation(label["q_vbs2tango_true"]) @ numpy.zeros(3) + r
                found = projected(places, camera["cameraMatrix"], camera["distCoeffs"])
                center = record(self.folder, int(pathlib.Path(label["filename"]).stem))["frames"][0]["truth"]["objects"][0]["center_px"]
                self.assertLess(numpy.abs(found - center).max(), 1e-4)
                count += 1
        self.assertEqual(count, 8)

    def test_shards(self):
        samples = {}
        for shard in sorted((self.folder / "shards").glob("*.tar")):
            with tarfile.open(shard) as tar:
                keys = []
                for member in tar:
                    key, _, kind = member.name.partition(".")
                    if key not in keys:
                        keys.append(key)
                    self.assertEqual(keys[-1], key)  # a sample's files lie together
                    samples.setdefault(key, {})[kind] = tar.extractfile(member).read()
                self.assertLessEqual(len(keys), 3)
        self.assertEqual(sorted(samples), sorted(self.names))
        for key, sample in samples.items():
            self.assertEqual(sample["png"], (self.folder / f"images/{key}.png").read_bytes())
            self.assertEqual(json.loads(sample["json"])["name"], key)


    def test_the_page_compares_with_an_older_campaign(self):
        older = self.top / "older"
        shutil.copytree(self.folder, older)
        index = (older / "index.csv").read_text().split("\n")
        index[2] = index[2].replace(",done,,", ",failed,too dark,")
        (older / "index.csv").write_text("\n".join(index))
        subprocess.run([HILCAM.parent / "hilcam-plot-campaign", older, self.folder], check=True)
        page = (older / "index.html").read_text()
        self.assertIn("8 cases are in both; 1 have another outcome", page)
        self.assertIn("<td>000002</td><td>done</td><td>failed</td><td>too dark</td>", page)


class Hidden(unittest.TestCase):
    """BOP's labels where one object hides another, and a third is cut by the frame: two cubes of 2 m of one make, the first 10 m
    away and the second, small by its scale, before its right half; a big one at the frame's left edge."""

    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        top = pathlib.Path(cls.temporary.name)
        corners = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
        quads = [(1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4)]
        (top / "cube.obj").write_text("".join(f"v {x} {y} {z}\n" for x, y, z in corners) + "".join(f"f {a} {b} {c} {d}\n" for a, b, c, d in quads))
        scenario = yaml.safe_load(SCENARIO.read_text())
        # World axes are the camera's.
        scenario["time_utc"] = "2026-03-20T14:00:00Z"
        scenario["camera_pose"] = {"position_m": [0, 0, 0], "attitude": "quaternion", "attitude_wxyz": [1, 0, 0, 0]}
        cube = lambda name, place, scale=1: {"name": name, "mesh": "cube.obj", "scale": scale,
                                             "pose": {"position_m": place, "attitude": "quaternion", "attitude_wxyz": [0.9, 0.3, 0.3, 0.1]}}
        scenario["objects"] = [cube("behind", [0.2, 0.1, 10]), cube("before", [0.6, 0.1, 6], 0.4), cube("cut", [-1.4, 0.2, 5], 0.5), cube("gone", [0, 0, -5])]
        (top / "scenario.yaml").write_text(yaml.safe_dump(scenario))
        cls.folder = top / "out"
        campaign("name: hidden\nscenario: scenario.yaml\nlabels: [bop, coco]\n", cls.folder, "--jobs", 1)
        cls.scene = cls.folder / "bop/all/000000"
        cls.camera, cls.poses, cls.infos = (json.loads((cls.scene / f"scene_{n}.json").read_text())["0"] for n in ("camera", "gt", "gt_info"))

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def mask(self, kind, instance):
        return numpy.array(Image.open(self.scene / f"{kind}/000000_{instance:06d}.png")) > 0

    def places(self, instance):
        """The model's corners in the picture, by cam_K and the pose, in px from its corner."""
        vertices, _, _ = ply(self.folder / f"bop/models/obj_{self.poses[instance]['obj_id']:06d}.ply")
        k, r = (numpy.array(v).reshape(3, 3) for v in (self.camera["cam_K"], self.poses[instance]["cam_R_m2c"]))
        seen = (vertices @ r.T + self.poses[instance]["cam_t_m2c"]) @ k.T
        return seen[:, :2] / seen[:, 2:] + 0.5

    def test_masks_have_what_is_hidden(self):
        for i, info in enumerate(self.infos):
            whole, visible = self.mask("mask", i), self.mask("mask_visib", i)
            self.assertFalse((visible & ~whole).any())
            self.assertEqual(int(visible.sum()), info["px_count_visib"])
            if info["px_count_all"]:
                self.assertEqual(info["visib_fract"], info["px_count_visib"] / info["px_count_all"])
        behind, before = self.mask("mask", 0), self.mask("mask", 1)
        # Wherever both are, the nearer one is seen.
        self.assertGreater((behind & before).sum(), 100)
        self.assertTrue((self.mask("mask_visib", 0) == behind & ~before).all())
        self.assertEqual((self.infos[0]["px_count_all"], self.infos[0]["bbox_obj"]), (behind.sum(), box_of(behind)))
        self.assertLess(self.infos[0]["visib_fract"], 1)
        self.assertEqual(self.infos[1]["visib_fract"], 1)
        # The hidden part counts: what hides it has a depth.
        self.assertEqual(self.infos[0]["px_count_valid"], self.infos[0]["px_count_all"])

    def test_what_lies_beside_the_frame_counts(self):
        info, whole = self.infos[2], self.mask("mask", 2)
        self.assertEqual(info["px_count_valid"], whole.sum())
        self.assertEqual(info["px_count_visib"], whole.sum())
        self.assertGreater(info["px_count_all"], whole.sum())
        self.assertLess(info["bbox_obj"][0], 0)
        self.assertEqual(info["bbox_visib"], box_of(whole))

    def test_what_is_not_seen_has_nothing(self):
        self.assertEqual(self.infos[3], {"bbox_obj": [-1] * 4, "bbox_visib": [-1] * 4, "px_count_all": 0, "px_count_valid": 0, "px_count_visib": 0, "visib_fract": 0})
        self.assertFalse(self.mask("mask", 3).any() or self.mask("mask_visib", 3).any())

    def test_models_lie_where_the_masks_are(self):
        """A cube's silhouette is the convex hull of its corners: every pixel's middle in it is the mask's, and no other."""
        height, width = self.mask("mask", 0).shape
        y, x = numpy.mgrid[0:height, 0:width] + 0.5
        for i in range(3):
            corners = self.places(i)
            left, top, across, down = self.infos[i]["bbox_obj"]
            self.assertLess(numpy.abs(corners.min(0) - [left, top]).max(), 1)
            self.assertLess(numpy.abs(corners.max(0) - [left + across, top + down]).max(), 1)
            # How far a pixel's middle lies outside of the hull, by the support function across every two corners: the hull's edges are among them.
            outside = numpy.full((height, width), -numpy.inf)
            for a, b in itertools.permutations(numpy.unique(corners, axis=0), 2):
                c, s = numpy.array([a[1] - b[1], b[0] - a[0]]) / numpy.hypot(*(a - b))
                numpy.maximum(outside, x * c + y * s - (corners @ [c, s]).max(), out=outside)
            mask = self.mask("mask", i)
            self.assertLess(outside[mask].max(), 1e-2)
            self.assertGreater(outside[~mask].min(), -1e-2)

    def test_each_object_has_its_model(self):
        info = json.loads((self.folder / "bop/models/models_info.json").read_text())
        self.assertEqual(list(info), ["1", "2", "3", "4"])
        for i, scale in zip(range(1, 5), (1, 0.4, 0.5, 1)):
            vertices, normals, triangles = ply(self.folder / f"bop/models/obj_{i:06d}.ply")
            check_model(self, vertices, normals, triangles, info[str(i)])
            self.assertAlmostEqual(info[str(i)]["diameter"], 2000 * scale * math.sqrt(3), 2)
            self.assertAlmostEqual(info[str(i)]["min_x"], -1000 * scale, 3)
            # Normals point outwards.
            self.assertTrue((numpy.einsum("ij,ij->i", vertices, normals) > 0).all())

    def test_a_shape_that_varies_has_no_model(self):
        folder = self.folder.parent / "scales/out"
        (folder.parent).mkdir()
        for name in ("scenario.yaml", "cube.obj"):
            shutil.copy(self.folder.parent / name, folder.parent)
        text = "name: scales\nscenario: scenario.yaml\nvary: [{key: objects.1.scale, uniform: [0.3, 0.5]}]\nlabels: [bop]\n"
        (folder.parent / "scenario.yaml").write_text((self.folder.parent / "scenario.yaml").read_text().replace("../../configs", f"{SOURCE}/configs"))
        campaign(text, folder, "--jobs", 1)
        self.assertEqual(sorted(p.name for p in (folder / "bop/models").iterdir()), ["models_info.json", "obj_000001.ply", "obj_000003.ply", "obj_000004.ply"])

    def test_records_of_an_older_program_are_named(self):
        older = self.folder.parent / "older/out"
        older.parent.mkdir()
        for name in ("scenario.yaml", "cube.obj"):
            shutil.copy(self.folder.parent / name, older.parent)
        campaign("name: hidden\nscenario: scenario.yaml\nlabels: [bop, coco]\n", older, "--jobs", 1)
        case = record(older, 1)
        del case["frames"][0]["silhouettes"]
        (older / "cases/000001.json").write_text(json.dumps(case))
        result = campaign("name: hidden\nscenario: scenario.yaml\nlabels: [bop, coco]\n", older, "--merge", expect=2)
        self.assertIn("000001.json: has no silhouettes", result.stderr)


class Flow(unittest.TestCase):
    def setUp(self):
        try:
            import OpenImageIO as oiio
        except ImportError:
            self.skipTest("python3-openimageio is missing")
        self.oiio = oiio

    def layer(self, file, *channels):
        image = self.oiio.ImageBuf(str(file))
        all_names = list(image.spec().channelnames)
        pixels = image.get_pixels(self.oiio.FLOAT)
        return numpy.stack([pixels[..., all_names.index(c)] for c in channels], -1).astype(float)

    def test_flow_is_where_the_points_go(self):
        """Every pixel of the target, by its place in camera axes: turned and carried by the two poses, and projected."""
        with tempfile.TemporaryDirectory() as top:
            folder = pathlib.Path(top) / "out"
            text = CAMPAIGN.replace("count: 8", "count: 2").replace("labels: [coco, bop, yolo, speed]", "labels: []")
            text = text.replace("set: [", "set: ['objects.0.pose.rate_deg_s=[3, 20, -8]', ")
            text += "pictures: {count: 2, interval_s: 0.4, flow: true, layers: [object, position]}\n"
            campaign(text, folder, "--jobs", 1)

            for number in (1, 2):
                before, after = (f["truth"] for f in record(folder, number)["frames"])
                place = self.layer(folder / f"layers/{number:06d}_01.exr", "position.X", "position.Y", "position.Z")
                mask = numpy.isfinite(place[..., 2]) & (place[..., 2] < 1e6)
                self.assertGreater(mask.sum(), 100)
                a, b = before["objects"][0], after["objects"][0]
                body = (place[mask] - a["position_camera_m"]) @ rotation(a["camera_from_body_wxyz"])
                moved = body @ rotation(b["camera_from_body_wxyz"]).T + b["position_camera_m"]
                fx, fy = after["image"]["focal_length_px"]
                cx, cy = after["image"]["principal_point_px"]
                there = projected(moved, [[fx, 0, cx], [0, fy, cy], [0, 0, 1]], after["image"]["distortion"])
                y, x = numpy.nonzero(mask)
                expected = there - numpy.stack([x + 0.5, y + 0.5], -1)
                found = self.layer(folder / f"flow/{number:06d}_01.exr", "flow.X", "flow.Y")[mask]
                self.assertLess(numpy.abs(found - expected).max(), 0.1)
                self.assertGreater(numpy.abs(found).max(), 1)

    def test_flow_and_points_turn_with_a_part(self):
        """The wings of a spacecraft turn by joints about the body's y axis, so what lies far along it is a wing's, whatever it is turned by."""
        with tempfile.TemporaryDirectory() as top:
            folder = pathlib.Path(top) / "out"
            (folder.parent / "wing.csv").write_text("name,x_m,y_m,z_m,part\nbody,0.5,0.2,-0.3,\nwing,0.5,5,-0.3,wing_north\n")
            text = (f"name: wings\nscenario: {SOURCE}/configs/scenarios/small.yaml\n"
                    "set: [objects.0.generate.triangles=5000, camera.width_px=256, camera.height_px=256, camera.focal_length_mm=2.25, objects.0.joints.0.rate_deg_s=25,\n"
                    "  objects.0.joints.1.rate_deg_s=-15, quality.path_model=direct, stars=null]\nkeypoints: [{file: wing.csv, tolerance_m: 100}]\n"
                    "labels: [coco]\npictures: {count: 2, interval_s: 0.4, flow: true, layers: [object, position]}\n")
            campaign(text, folder, "--jobs", 1)

            frames = record(folder, 1)["frames"]
            before, after = (f["truth"] for f in frames)
            place = self.layer(folder / "layers/000001_01.exr", "position.X", "position.Y", "position.Z")
            flow = self.layer(folder / "flow/000001_01.exr", "flow.X", "flow.Y")
            fx, fy = after["image"]["focal_length_px"]
            cx, cy = after["image"]["principal_point_px"]
            parts = [{p["name"].split("/")[1]: p for p in truth["parts"]} for truth in (before, after)]
            seen = numpy.isfinite(place[..., 2]) & (place[..., 2] < 1e6)
            body = before["objects"][0]
            along = numpy.where(seen, ((place - body["position_camera_m"]) @ rotation(body["camera_from_body_wxyz"]))[..., 1], 0)

            def gone(mask, a, b, key):
                own = (place[mask] - a["position_camera_m"]) @ rotation(a[key])
                moved = own @ rotation(b[key]).T + b["position_camera_m"]
                y, x = numpy.nonzero(mask)
                return projected(moved, [[fx, 0, cx], [0, fy, cy], [0, 0, 1]], [0] * 5) - numpy.stack([x + 0.5, y + 0.5], -1)

            whole = "camera_from_body_wxyz"
            for name, mask in (("wing_north", seen & (along > 4)), ("wing_south", seen & (along < -4))):
                self.assertGreater(mask.sum(), 100, name)
                self.assertLess(numpy.abs(flow[mask] - gone(mask, parts[0][name], parts[1][name], "camera_from_part_wxyz")).max(), 0.1)
                self.assertGreater(numpy.abs(flow[mask] - gone(mask, body, after["objects"][0], whole)).max(), 1)
            mask = seen & (numpy.abs(along) < 0.8)
            self.assertLess(numpy.abs(flow[mask] - gone(mask, body, after["objects"][0], whole)).max(), 0.1)
            # A point of the wing is where the wing's pose has it, one of the body where the body's has it.
            for frame, now in zip(frames, parts):
                thing, point = frame["truth"]["objects"][0], numpy.array([0.5, 5, -0.3])
                for (name, x, y, _), where in zip(frame["keypoints"]["1"], (
                        rotation(thing[whole]) @ numpy.array([0.5, 0.2, -0.3]) + thing["position_camera_m"],
                        rotation(now["wing_north"]["camera_from_part_wxyz"]) @ point + now["wing_north"]["position_camera_m"])):
                    expected = projected(where, [[fx, 0, cx], [0, fy, cy], [0, 0, 1]], [0] * 5)
                    self.assertLess(numpy.abs(expected - (x, y)).max(), 1e-4, name)
            ends = [frame["keypoints"]["1"][1][1:3] for frame in frames]
            self.assertGreater(math.dist(*ends), 1)


class Killed(unittest.TestCase):
    def test_ten_kills_leave_no_trace(self):
        with tempfile.TemporaryDirectory() as top:
            top = pathlib.Path(top)
            text = CAMPAIGN.replace("count: 8", "count: 60")
            whole, broken = top / "whole/out", top / "broken/out"
            started = time.monotonic()
            campaign(text, whole)
            took = time.monotonic() - started
            draw = random.Random(3)
            (broken.parent).mkdir()
            shutil.copy(whole.parent / "campaign.yaml", broken.parent)
            shutil.copy(whole.parent / "points.csv", broken.parent)
            records = lambda: len(list((broken / "cases").glob("0*.json")))
            done = [0]
            for kill in range(10):
                process = subprocess.Popen([HILCAM, "campaign", broken.parent / "campaign.yaml", "--out", broken],
                                           stderr=subprocess.DEVNULL, start_new_session=True)
                # Every other kill comes once this process has finished cases, however long it loads, in the middle of later ones;
                # the others come at any time, most of them while it loads.
                if kill % 2 == 0:
                    wanted, end = done[-1] + draw.randint(1, 5), time.monotonic() + 120
                    while records() < wanted and process.poll() is None and time.monotonic() < end:
                        time.sleep(0.002)
                    time.sleep(draw.uniform(0, 0.05))
                else:
                    time.sleep(draw.uniform(0.05, 0.3) * min(took, 4))
                self.assertIsNone(process.poll(), "the campaign ended before it was killed")
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()
                done.append(records())
            self.assertEqual(done, sorted(done))
            # The five kills that waited for cases have each left some more.
            self.assertGreaterEqual(len(set(done)), 6, done)
            self.assertLess(done[-1], 60)
            campaign(text, broken)
            self.assertEqual(contents(broken), contents(whole))
            self.assertEqual([p for p in broken.rglob(".unfinished*")], [])


class Failing(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.top = pathlib.Path(self.temporary.name)
        self.folder = self.top / "out"

    def tearDown(self):
        self.temporary.cleanup()

    def test_a_value_that_the_scenario_refuses_fails_its_case_alone(self):
        result = campaign(f"name: bad\nscenario: {SCENARIO}\ncount: 3\ntable: t.csv\n", self.folder, expect=2)
        self.assertIn("t.csv", result.stderr)
        (self.top / "t.csv").write_text("camera.exposure_ms\n0.1\n-1\n0.2\n")
        result = campaign(f"name: bad\nscenario: {SCENARIO}\ncount: 3\ntable: t.csv\n", self.folder, expect=1)
        self.assertRegex(result.stderr, r"000002: .*camera.exposure_ms: found '-1'; accepted: a number")
        self.assertEqual([row["outcome"] for row in rows(self.folder)], ["done", "failed", "done"])
        page = (self.folder / "index.html").read_text()
        self.assertLess(page.index("found &#x27;-1&#x27;"), page.index("What was covered"))

    def test_impossible_constraints_say_what_was_tried(self):
        text = CAMPAIGN.replace("lit_share: 0.05, tries: 50", "lit_share: 1, tries: 3").replace("uniform: [0, 110]", "value: 179")
        result = campaign(text.replace("count: 8", "count: 2"), self.folder, expect=1)
        self.assertIn("000001: none of 3 tries is what is asked for: require.lit_share was not met by 3 (at best", result.stderr)

    def test_the_documented_campaign_is_one(self):
        page = (SOURCE / "docs/campaigns.md").read_text()
        text = page.split("```yaml poses.yaml\n")[1].split("```")[0]
        campaign(text.replace("300000", "20000"), self.folder, "--set", "count=1", "--set", "set=[objects.0.generate.triangles=20000, "
                 "objects.0.pose.attitude=quaternion, quality.path_model=direct, camera.width_px=256, camera.height_px=256]")
        self.assertEqual([row["outcome"] for row in rows(self.folder)], ["done"])
        runs = page.split("```yaml runs.yaml\n")[1].split("```")[0]
        (self.top / "scenario.yaml").write_text(SCENARIO.read_text().replace("../../configs/", f"{SOURCE}/configs/"))
        (self.top / "controller").write_text("#!/bin/sh\necho '{\"arguments\": '$#'}' > $6\n")
        (self.top / "controller").chmod(0o755)
        runs = runs.replace("./controller", str(self.top / "controller")).replace(', "outputs.gige.interface=127.0.0.{slot}"', "")
        campaign(runs, self.top / "runs", "--set", "count=1", "--set", "set=[commands.udp.port=5010]")
        self.assertEqual(rows(self.top / "runs")[0]["result.arguments"], "6")

    def test_another_campaign_is_never_overwritten(self):
        campaign(f"name: a\nscenario: {SCENARIO}\n", self.folder)
        before = contents(self.folder)
        result = campaign(f"name: a\nscenario: {SCENARIO}\nseed: 2\n", self.folder, expect=2)
        self.assertIn("holds another campaign (seed: '1' there, '2' here); accepted: another folder", result.stderr)
        self.assertEqual(contents(self.folder), before)

    def test_what_does_not_fit_onto_a_full_disk_comes_later_by_the_same_command(self):
        """On a file system of 400 KB in a name space of its own."""
        disk = self.top / "disk"
        disk.mkdir()
        if subprocess.run(["unshare", "-rm", "mount", "-t", "tmpfs", "tmpfs", disk], capture_output=True).returncode:
            self.skipTest("no name space for a file system of its own")
        text = CAMPAIGN.replace("count: 8", "count: 6").replace("labels: [coco, bop, yolo, speed]", "labels: [bop]").replace("shard_samples: 3", "")
        (self.top / "campaign.yaml").write_text(text)
        (self.top / "points.csv").write_text("name,x_m,y_m,z_m\na,0,0,0\n")
        script = (f"mount -t tmpfs -o size=400k tmpfs {disk} && {HILCAM} campaign {self.top}/campaign.yaml --out {disk}/out; echo first $? >&2;"
                  f"ls {disk}/out/cases | wc -l >&2; mount -o remount,size=20m {disk} && {HILCAM} campaign {self.top}/campaign.yaml --out {disk}/out;"
                  f"echo second $? >&2; cp -r {disk}/out {self.top}/copy")
        result = subprocess.run(["unshare", "-rm", "sh", "-c", script], capture_output=True, text=True, timeout=120)
        self.assertIn("first 1", result.stderr, result.stderr)
        self.assertIn("No space left on device", result.stderr)
        self.assertIn("second 0", result.stderr, result.stderr)
        self.assertEqual([row["outcome"] for row in rows(self.top / "copy")], ["done"] * 6)


def children_of(process):
    out = subprocess.run(["ps", "-o", "pid=", "--ppid", str(process)], capture_output=True, text=True).stdout
    return [int(word) for word in out.split()]


def wait_for(what, process, limit_s=100):
    end = time.monotonic() + limit_s
    while not what() and process.poll() is None and time.monotonic() < end:
        time.sleep(0.005)


class Interrupted(unittest.TestCase):
    """What the machine or its user does to a campaign is no outcome of its cases."""

    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name) / "out"
        self.text = CAMPAIGN.replace("count: 8", "count: 40")

    def tearDown(self):
        self.temporary.cleanup()

    def begin(self, text):
        self.folder.parent.mkdir(exist_ok=True)
        (self.folder.parent / "campaign.yaml").write_text(text)
        (self.folder.parent / "points.csv").write_text("name,x_m,y_m,z_m\norigin,0,0,0\n")
        # A session of its own, as a shell in a terminal gives it: a signal to the group is Ctrl-C.
        return subprocess.Popen([HILCAM, "campaign", self.folder.parent / "campaign.yaml", "--out", self.folder, "--jobs", "2"],
                                stderr=subprocess.PIPE, text=True, start_new_session=True)

    def records(self):
        return len(list((self.folder / "cases").glob("0*.json")))

    def again(self):
        return subprocess.run([HILCAM, "campaign", self.folder.parent / "campaign.yaml", "--out", self.folder],
                              capture_output=True, text=True, timeout=120)

    def test_a_signal_says_how_to_go_on_and_ends_all(self):
        for send in (lambda pid: os.killpg(pid, signal.SIGINT), lambda pid: os.kill(pid, signal.SIGTERM)):
            before = self.records()
            process = self.begin(self.text)
            wait_for(lambda: self.records() >= before + 3, process)
            workers = children_of(process.pid)
            self.assertEqual(len(workers), 2)
            send(process.pid)
            errors = process.communicate(timeout=20)[1]
            self.assertEqual(process.returncode, 130, errors)
            self.assertIn(f"{self.records()} of 40 done; the same command goes on", errors)
            self.assertEqual([pid for pid in workers if os.path.exists(f"/proc/{pid}")], [])
        result = self.again()
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("40 done, 0 failed", result.stderr)

    def test_a_signal_while_it_loads_says_so_too(self):
        process = self.begin(self.text)
        wait_for(lambda: (self.folder / "campaign.txt").exists(), process)
        os.kill(process.pid, signal.SIGINT)
        errors = process.communicate(timeout=20)[1]
        self.assertEqual(process.returncode, 130, errors)
        self.assertRegex(errors, r"(0 of 40 done|interrupted); the same command goes on")

    def test_killed_workers_leave_no_failed_cases(self):
        process = self.begin(self.text)
        for _ in range(3):
            wait_for(lambda: len(children_of(process.pid)) == 2 and self.records() >= 2, process)
            for worker in children_of(process.pid):
                os.kill(worker, signal.SIGKILL)
            wait_for(lambda: False, process, 0.3)
        errors = process.communicate(timeout=100)[1]
        self.assertEqual(process.returncode, 1, errors)
        self.assertIn("its process was ended: signal 9", errors)
        self.assertRegex(errors, r"\d+ done, 0 failed, \d+ not made")
        result = self.again()
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("40 done, 0 failed", result.stderr)

    def test_lost_pictures_are_noticed_and_made_anew(self):
        text = CAMPAIGN.replace("count: 8", "count: 4")
        campaign(text, self.folder)
        whole = contents(self.folder)
        (self.folder / "images/000002.png").unlink()
        (self.folder / "views/000003.png").write_bytes(b"")
        (self.folder / "cases/000004.json").write_text("{")
        merged = campaign(text, self.folder, "--merge", expect=1)
        self.assertIn("000002: images/000002.png is missing", merged.stderr)
        self.assertRegex(merged.stderr, r"000003: views/000003.png has 0 bytes of \d+")
        self.assertIn("1 done, 0 failed, 3 not made, or without a file of theirs", merged.stderr)
        self.assertRegex(merged.stderr, "000004.json: is no record of a case")
        listed = [image["file_name"] for file in (self.folder / "coco").glob("*.json") for image in json.loads(file.read_text())["images"]]
        self.assertEqual([pathlib.Path(name).stem for name in listed], ["000001"])
        campaign(text, self.folder)
        self.assertEqual(contents(self.folder), whole)

    def test_a_run_that_is_interrupted_ends_its_programs(self):
        program = self.folder.parent / "program.sh"
        self.folder.parent.mkdir(exist_ok=True)
        program.write_text("#!/bin/sh\nsleep 12345.25 &\nwait\n")
        process = self.begin(f"name: runs\nscenario: {SCENARIO}\nset: [mode=lockstep, commands.tcp.port=5010]\ncount: 2\n"
                             f"run: {{program: [/bin/sh, {program}]}}\n")
        asleep = lambda: subprocess.run(["ps", "-eo", "args"], capture_output=True, text=True).stdout.count("sleep 12345.25\n")
        wait_for(lambda: asleep() >= 2, process)
        self.assertGreaterEqual(asleep(), 2)
        os.killpg(process.pid, signal.SIGINT)
        errors = process.communicate(timeout=20)[1]
        self.assertEqual(process.returncode, 130, errors)
        self.assertIn("0 of 2 done; the same command goes on", errors)
        self.assertEqual(asleep(), 0)


class Kept(unittest.TestCase):
    """What cases leave in the cache."""

    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.top = pathlib.Path(self.temporary.name)
        (self.top / "cube.obj").write_text(CUBE)
        (self.top / "scenario.yaml").write_text(
            "time_utc: 2026-12-21T00:00:00Z\n"
            "camera: {width_px: 64, height_px: 64, pitch_um: 10, focal_length_mm: 6.4, f_number: 8, transmission: 0.01, quantum_efficiency: 0.5,\n"
            "  full_well_e: 20000, gain_dn_e: 0.2, bits: 12, exposure_ms: 20}\n"
            "objects:\n  - {name: cube, mesh: cube.obj, pose: {position_m: [0, 0, 10]}}\n"
            "earth: {visible: false}\nmoon: {visible: false}\nspectrum_edges_um: [0.5, 0.7]\nquality: {path_model: cached, probes: 1000}\n")
        self.cache = self.top / "cache"

    def tearDown(self):
        self.temporary.cleanup()

    def make(self, text, name="out"):
        (self.top / "campaign.yaml").write_text("name: kept\nscenario: scenario.yaml\n" + text)
        result = subprocess.run([HILCAM, "campaign", self.top / "campaign.yaml", "--out", self.top / name], capture_output=True, text=True,
                                timeout=120, env=os.environ | {"HILCAM_CACHE": str(self.cache)})
        self.assertEqual(result.returncode, 0, result.stderr)
        return sorted(path.name for path in self.cache.glob("transfer_*"))

    def test_cases_of_all_sizes_share_one_table(self):
        files = self.make("count: 6\nvary: [{key: objects.0.scale, uniform: [0.3, 3]}]\n")
        self.assertEqual(len(files), 1)
        frames = [(self.top / f"out/images/{n:06d}.png").read_bytes() for n in range(1, 7)]
        self.assertEqual(len(set(frames)), 6)

    def test_tables_of_one_case_are_not_kept(self):
        own = "count: 4\nvary: [{key: quality.probes, whole: [1500, 2500]}]\n"
        self.assertEqual(len(self.make(own)), 1)  # the scenario's own

    def test_tables_of_a_choice_are_kept(self):
        self.assertEqual(len(self.make("count: 4\nseed: 2\nvary: [{key: quality.probes, choice: [1500, 2500]}]\n")), 3)


class Programs(unittest.TestCase):
    """Runs of the bench with a program beside each."""

    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name) / "out"
        program = pathlib.Path(cls.temporary.name) / "program.py"
        program.write_text(f"""
import json, os, sys, time
sys.path.insert(0, {str(SOURCE / 'tools/client')!r})
from hilcam_client import Client, Expose
case = int(sys.argv[1])
if case == 2: sys.exit("controller diverged")
if case == 3: time.sleep(600)
if case == 4: os.kill(os.getpid(), 11)
with Client("tcp:127.0.0.1:" + os.environ["HILCAM_TCP_PORT"], timeout_s=30) as camera:
    for n in range(1, 4):
        camera.send(Expose(time_tai_ns=(1774015200 + 37 + n) * 10**9))
with open(os.path.join(sys.argv[2], "result.json"), "w") as result:
    result.write("words" if case == 6 else json.dumps({{"error_m": case / 10}}))
""")
        cls.result = campaign(f"""
name: runs
scenario: {SCENARIO}
set: [mode=lockstep, commands.tcp.port=5010]
count: 6
vary: [{{key: camera.exposure_ms, uniform: [0.1, 0.2]}}]
run:
  program: [/usr/bin/python3, {program}, "{{case}}", "{{case_folder}}"]
  set: ["outputs.files.folder={{case_folder}}/frames"]
time_limit_s: 6
""", cls.folder, "--jobs", 3, expect=1)
        cls.rows = rows(cls.folder)

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def test_a_program_that_goes_wrong_is_one_failed_case(self):
        self.assertEqual([row["outcome"] for row in self.rows], ["done", "failed", "failed", "failed", "done", "failed"],
                         self.result.stderr)
        self.assertEqual(self.rows[1]["reason"], "the program ended with status 1: controller diverged")
        self.assertEqual(self.rows[2]["reason"], "the program took longer than 6 s (time_limit_s)")
        self.assertRegex(self.rows[3]["reason"], r"the program was ended by signal 11 \(Segmentation fault\)")
        self.assertEqual(self.rows[5]["reason"], "result.json: is no JSON at line 1, column 1")

    def test_results_logs_and_frames_are_kept(self):
        self.assertEqual([row["result.error_m"] for row in self.rows], ["0.1", "", "", "", "0.5", ""])
        for n in (1, 5):
            run = self.folder / f"runs/{n:06d}"
            self.assertEqual(json.loads((run / "report.json").read_text())["frames"], 3)
            self.assertEqual(len(list((run / "frames").glob("frame_*.png"))), 3)
            self.assertIn("running;", (run / "hilcam.log").read_text())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=2)
