"""A campaign's results (docs/campaigns.md) as tables and arrays."""
import csv
import dataclasses
import json
import pathlib
import subprocess
from typing import Any, Dict, Iterator, List, Optional, Sequence, Union

import numpy

from .exr import read_exr
from .masks import mask_of_run_lengths
from .truth import FrameTruth

PathLike = Union[str, pathlib.Path]


def _mask_in(frame: Dict[str, Any], text: Optional[str]) -> numpy.ndarray:
    image = frame["truth"]["image"]
    size = (image["height_px"], image["width_px"])
    return numpy.zeros(size, bool) if text is None else mask_of_run_lengths(text, *size)


@dataclasses.dataclass(frozen=True)
class Case:
    number: int
    name: str
    split: str
    done: bool
    reason: str
    seed: int
    set: Sequence[str]  # KEY=VALUE words that make it: `hilcam render SCENARIO --set ...`
    parameters: Dict[str, str]
    figures: Dict[str, float]
    record: Dict[str, Any] = dataclasses.field(repr=False, compare=False)


class Campaign:
    """The results in a folder; files are read when they are asked for."""

    def __init__(self, folder: PathLike):
        self.folder = pathlib.Path(folder)
        self.index = self._rows("index.csv")
        if not self.index:
            raise ValueError(f"{self.folder}: index.csv has no case")

    @classmethod
    def make(cls, file: PathLike, out: PathLike, *options: str, program: str = "hilcam") -> "Campaign":
        """Has `hilcam campaign` make it, or go on, and gives what there is then, failed cases and all.

        subprocess.CalledProcessError when it could not be made at all; its stderr says why."""
        command = [program, "campaign", str(file), "--out", str(out), *options]
        result = subprocess.run(command, stderr=subprocess.PIPE, text=True)
        if result.returncode not in (0, 1):
            raise subprocess.CalledProcessError(result.returncode, command, stderr=result.stderr)
        return cls(out)

    def _rows(self, name: str) -> List[Dict[str, str]]:
        with open(self.folder / name, newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def __len__(self) -> int:
        return len(self.index)

    def __iter__(self) -> Iterator[Case]:
        return (self.case(int(row["case"])) for row in self.index)

    @property
    def columns(self) -> List[str]:
        return list(self.index[0])

    def column(self, name: str) -> numpy.ndarray:
        """A column of the index: numbers, NaN where there is none; text where it is no numbers."""
        values = [row[name] for row in self.index]
        try:
            return numpy.array([float(v) if v else numpy.nan for v in values])
        except ValueError:
            return numpy.array(values)

    @property
    def done(self) -> numpy.ndarray:
        return self.column("outcome") == "done"

    def table(self) -> numpy.ndarray:
        """The whole index as a structured array, for numpy or pandas.DataFrame(campaign.table())."""
        columns = [self.column(name) for name in self.columns]
        out = numpy.empty(len(self), dtype=[(n, c.dtype) for n, c in zip(self.columns, columns)])
        for name, column in zip(self.columns, columns):
            out[name] = column
        return out

    def case(self, number: int) -> Case:
        record = json.loads((self.folder / f"cases/{number:06d}.json").read_text(encoding="utf-8"))
        return Case(record["case"], record["name"], record["split"], record["outcome"] == "done", record["reason"], record["seed"],
                    tuple(record["set"]), record["parameters"], record["figures"], record)

    def truth(self, number: int) -> List[FrameTruth]:
        """Of each picture of a case."""
        return [FrameTruth.of(frame["truth"]) for frame in self.case(number).record["frames"]]

    def mask(self, number: int, object: int = 1, picture: int = 0) -> numpy.ndarray:
        """Where an object is visible: booleans, of the picture's size."""
        frame = self.case(number).record["frames"][picture]
        return _mask_in(frame, frame["masks"].get(str(object)))

    def silhouette(self, number: int, object: int = 1, picture: int = 0) -> numpy.ndarray:
        """What a whole object covers, also behind others: booleans, of the picture's size. Of a campaign with labels of BOP."""
        frame = self.case(number).record["frames"][picture]
        if "silhouettes" not in frame:
            raise KeyError(f"{self.folder}: case {number} has no silhouettes; a campaign with bop among its labels has them")
        return _mask_in(frame, frame["silhouettes"].get(str(object), {}).get("mask"))

    def _file(self, kind: str, number: int, picture: int, endings: Sequence[str]) -> pathlib.Path:
        stem = self.case(number).record["frames"][picture]["name"]
        for ending in endings:
            if (self.folder / kind / (stem + ending)).is_file():
                return self.folder / kind / (stem + ending)
        raise FileNotFoundError(f"{self.folder / kind / stem}: no such file ({', '.join(endings)})")

    def layers(self, number: int, picture: int = 0) -> Dict[str, numpy.ndarray]:
        """The layers that `pictures.layers` asked for, a channel each: "object.ID", "depth.Z", "normal.X", ..."""
        return read_exr(self._file("layers", number, picture, [".exr"]))

    def flow(self, number: int, picture: int = 0) -> numpy.ndarray:
        """Height x width x 2, to the right and down [px], to the next picture; 1e10: unknown."""
        channels = read_exr(self._file("flow", number, picture, [".exr"]))
        return numpy.stack([channels["flow.X"], channels["flow.Y"]], -1)

    def variance(self, number: int, picture: int = 0) -> numpy.ndarray:
        """Variance of each pixel's number by the sensor's noise [DN^2]; 0: the pixel is full."""
        return read_exr(self._file("variance", number, picture, [".exr"]))["variance.DN2"]

    def image(self, number: int, picture: int = 0) -> numpy.ndarray:
        """The frame's digital numbers, of PNG or TIFF files. Needs Pillow."""
        from PIL import Image
        with Image.open(self._file("images", number, picture, [".png", ".tiff"])) as image:
            return numpy.array(image)

    def view(self, number: int, picture: int = 0) -> numpy.ndarray:
        """The same to look at, 8 bits. Needs Pillow."""
        from PIL import Image
        with Image.open(self._file("views", number, picture, [".png"])) as image:
            return numpy.array(image)

    def failures(self) -> Dict[str, str]:
        """Why cases have failed, by their names."""
        return {row["case"]: row["reason"] for row in self.index if row["outcome"] != "done"}

    def compared(self, other: "Campaign") -> Dict[str, Optional[str]]:
        """Cases of both whose outcomes differ: by name the reason why now, None where it is done now."""
        before = {row["case"]: row["outcome"] for row in other.index}
        return {row["case"]: row["reason"] or None for row in self.index if before.get(row["case"], row["outcome"]) != row["outcome"]}
