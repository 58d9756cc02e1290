"""The names of the library and where they live: read by type checkers, and by lazy_loader as it is used."""

from .arrivals.aspects_study import aspects as aspects
from .arrivals.aspects_study import find_aspects as find_aspects
from .arrivals.drop import drop as drop
from .arrivals.drop import shake as shake
from .arrivals.entry import Shares as Shares
from .arrivals.entry import shares as shares
from .arrivals.floor import floor as floor
from .base import errors as errors
from .base.errors import (
    ConfigError as ConfigError,
)
from .base.errors import (
    Faults as Faults,
)
from .base.errors import (
    FeederError as FeederError,
)
from .base.errors import (
    MeshError as MeshError,
)
from .base.version import __version__ as __version__
from .bowl.arguments import read_bowl as read_bowl
from .bowl.record import Bowl as Bowl
from .designing.advice import advise as advise
from .designing.design import DesignSearch as DesignSearch
from .designing.design import design as design
from .feeding.compare import calibrate as calibrate
from .feeding.compare import compare as compare
from .feeding.rate import rate as rate
from .feeding.tune import tune as tune
from .feeding.well_oriented import Rate as Rate
from .jobs.batch.sweep import sweep as sweep
from .machine.sheet import size_bowl as size_bowl
from .motion.convey import convey as convey
from .motion.conveying import Answer as Answer
from .motion.slide import slide as slide
from .output.report import report as report
from .part.inertia import inertia as inertia
from .part.loading import load as load
from .part.record import Part as Part
from .resting.aspects import Aspect as Aspect
from .resting.aspects import Aspects as Aspects
from .resting.aspects import write_names as write_names
from .resting.posture import Posture as Posture
from .resting.posture import posture as posture
from .sorting.headings import headings as headings
from .sorting.tooling import ToolingSearch as ToolingSearch
from .sorting.tooling import tooling as tooling
from .sorting.track import track as track
from .thesis.reproduction import reproduce as reproduce
from .trials.trial import TrialQueue as TrialQueue
from .trials.trial import trial as trial
