"""The names of the library and where they live: read by type checkers, and by lazy_loader as it is used."""

from .advising.advice import advise as advise
from .batch.sweep import sweep as sweep
from .bowl.record import Bowl as Bowl
from .conveying.answer import Answer as Answer
from .designing.design import DesignSearch as DesignSearch
from .designing.design import design as design
from .errors import (
    ConfigError as ConfigError,
)
from .errors import (
    Faults as Faults,
)
from .errors import (
    FeederError as FeederError,
)
from .errors import (
    MeshError as MeshError,
)
from .part.loading import load as load
from .part.record import Part as Part
from .rates.well_oriented import Rate as Rate
from .resting.aspects import Aspect as Aspect
from .resting.aspects import Aspects as Aspects
from .resting.aspects import write_names as write_names
from .resting.posture import Posture as Posture
from .resting.posture import posture as posture
from .studies.arguments import read_bowl as read_bowl
from .studies.aspects import aspects as aspects
from .studies.aspects import find_aspects as find_aspects
from .studies.aspects import inertia as inertia
from .studies.bowl import size_bowl as size_bowl
from .studies.compare import calibrate as calibrate
from .studies.compare import compare as compare
from .studies.convey import convey as convey
from .studies.drop import drop as drop
from .studies.drop import shake as shake
from .studies.floor import floor as floor
from .studies.headings import headings as headings
from .studies.rate import Shares as Shares
from .studies.rate import rate as rate
from .studies.rate import shares as shares
from .studies.report import report as report
from .studies.slide import slide as slide
from .studies.tooling import ToolingSearch as ToolingSearch
from .studies.tooling import tooling as tooling
from .studies.track import track as track
from .studies.trial import TrialQueue as TrialQueue
from .studies.trial import trial as trial
from .studies.tune import tune as tune
from .thesis.reproduction import reproduce as reproduce
from .version import __version__ as __version__
