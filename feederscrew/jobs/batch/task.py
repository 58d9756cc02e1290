"""Task of a batch for one part, and its outcome."""

import dataclasses
import hashlib
import json
import re
from dataclasses import dataclass, field
from importlib import metadata

from feederscrew import __version__
from feederscrew.bowl import Bowl
from feederscrew.bowl.verified import Verified, VoidTrial
from feederscrew.output.folder import LIBRARIES
from feederscrew.part.record import AspectNames

DONE = "done"
FAILED = "failed"
NOT_COMPUTED = "not computed"  # of a part to which a run that was stopped did not come
PARTS = "parts"  # folder of the results of a batch, one folder a part in it
THUMBNAIL = "thumbnail.png"  # among the files of a part
ELSEWHERE = re.compile(r"[,;] or pass `allow_open`[^;]*")  # advice that only a command of one part can take


@dataclass(frozen=True)
class Conditions:
    """One bowl file: where the parts are to travel."""

    name: str  # the file's stem; 'bowl' for the defaults
    bowl: Bowl
    texts: tuple[tuple[str, str], ...]  # key and value in effect, as text
    has_file: bool = False  # whether a bowl file was named
    warnings: tuple[str, ...] = ()  # what a machine makes of its drive
    tried: Verified | VoidTrial | None = None  # what the file says of its trial


@dataclass(frozen=True)
class Choices:
    """Settings of a batch that are the same for every part."""

    rule: str = "recommended"  # whose probabilities the rate takes
    drops: int = 0  # simulated drops of each part
    launch: str | None = None  # what is done to it; None: fed onto the bowl's moving floor
    pictures: bool = True

    @property
    def launched(self) -> str:
        """Return the launch where parts are not fed onto a moving floor."""
        from feederscrew.resting.rules.recommended import LAUNCH

        return self.launch or LAUNCH


@dataclass(frozen=True)
class Request:
    """One part in one bowl, as the user asked for it."""

    source: str  # path as typed
    conditions: Conditions
    options: tuple[tuple[str, str], ...] = ()  # units, density, centre_of_mass, body: those that were given
    name: str = ""  # of its folder, unlike any other of the batch
    aspect: str | None = None  # the one wanted; None for the orientation that leaves most often
    names: AspectNames | None = None  # of its aspects
    line: str = field(default="", compare=False)  # 'parts.csv:3', where a list names it


@dataclass(frozen=True, eq=False)
class Task:
    """A request with the bytes of its file: all that a worker needs, wherever it is."""

    request: Request
    choices: Choices
    data: bytes
    sha256: str  # of the bytes
    key: str  # of everything that the results hang on

    @classmethod
    def of(cls, request: Request, choices: Choices, data: bytes) -> "Task":
        """Make the task of a request, once its file is read."""
        sha256 = hashlib.sha256(data).hexdigest()
        values = {
            "part": sha256,
            "request": dataclasses.asdict(dataclasses.replace(request, line="")),
            "choices": dataclasses.asdict(choices),
            "version": __version__,
            "libraries": libraries(),
        }
        key = hashlib.sha256(json.dumps(values, sort_keys=True).encode()).hexdigest()
        return cls(request, choices, data, sha256, key)


@dataclass(frozen=True, eq=False)
class Outcome:
    """Outcome of one part; its files are ready to be put in place."""

    name: str  # of the folder
    key: str  # '' where another try may do better
    source: str
    sha256: str
    status: str  # DONE or FAILED
    reason: str = ""  # why it failed, one line
    row: dict[str, object] = field(default_factory=dict)  # its numbers, for the summary
    effective: dict[str, object] = field(default_factory=dict)  # the parameters that led to the numbers
    warnings: tuple[str, ...] = ()
    files: dict[str, bytes] = field(default_factory=dict)

    @classmethod
    def failed(cls, task: Task, reason: str, *, final: bool = True) -> "Outcome":
        """Make the outcome of a part that gave nothing; ``final`` if it would fail again."""
        request, reason = task.request, ELSEWHERE.sub("", " ".join(reason.split()))
        if request.source not in reason:
            reason = f"{request.source}: {reason}"
        reason = f"{request.line}: {reason}" if request.line else reason
        key = task.key if final else ""
        return cls(request.name, key, request.source, task.sha256, FAILED, reason)


def libraries() -> dict[str, str]:
    """Return the version of each library that has a say in the numbers or pictures, by name."""
    return {name: metadata.version(name) for name in LIBRARIES}
