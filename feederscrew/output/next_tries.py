"""Calls to paste after a design, each with its reason."""

from feederscrew.base.columns import Document
from feederscrew.base.units import PER_MINUTE, counted, listed
from feederscrew.bowl.verified import HELD
from feederscrew.designing import next_tries as decisions
from feederscrew.designing.calls import call_of, call_text, call_words, changed_options
from feederscrew.designing.next_tries import Evidence, NextTry, TryKind
from feederscrew.designing.record import DesignStudy

LABELS = ("try first", "then", "or")  # of the commands, the likeliest first
CALMER = ("calmer", "or")  # of those after a design that holds


def entries(study: DesignStudy) -> list[Document]:
    """Return what to try after a design, the likeliest to hold first.

    Parameters
    ----------
    study : DesignStudy

    Returns
    -------
    list of dict
        Of each ``label`` ('try first'), ``change`` (what is changed), ``evidence`` (what is known of it),
        ``why`` (a sentence), ``options`` of the call that are changed with their values (None of one that is
        left out), ``settings`` of the bowl beside them, ``words`` of the call, and ``command``, the same as
        one types it.
    """
    rows = []
    labels = CALMER if study.status in HELD else LABELS
    call = study.call or call_words(study.request, study.part)
    for label, one in zip(labels, decisions.next_tries(study), strict=False):
        words = call_of(one.request, study.request, call, one.settings)
        rows.append(
            {
                "label": label,
                "change": one.kind.value,
                "evidence": one.evidence.value,
                "why": reason(one),
                "options": changed_options(one.request, study.request),
                "settings": dict(one.settings),
                "words": list(words),
                "command": call_text(words),
            }
        )
    return rows


def reason(one: NextTry) -> str:
    """Return why a request is worth a try, as a sentence.

    Parameters
    ----------
    one : NextTry

    Returns
    -------
    str
    """
    rate = "" if one.rate is None else f"{one.rate / PER_MINUTE:.3g}/min"
    side = f"{one.aspect} up at any heading" if one.aspect else "that way up"
    match one.kind:
        case TryKind.PROOF:
            text = "the same design, proved to its end"
        case TryKind.LOWER_RATE if one.evidence is Evidence.HOLDS:
            text = f"{rate} holds: its draws and queues were run"
        case TryKind.LOWER_RATE if one.evidence is Evidence.CLEAN:
            text = f"a short trial was clean at {rate}; a queue brings less"
        case TryKind.LOWER_RATE:
            text = "a lower rate takes a calmer drive, which turns and loses fewer parts"
        case TryKind.ANOTHER_SIDE if one.evidence is Evidence.HOLDS:
            text = f"{one.aspect or 'hanging'} holds at {rate}: its draws and queues were run"
        case TryKind.ANOTHER_SIDE if one.evidence is Evidence.CLEAN:
            text = f"{one.aspect} up was clean in a short trial at {rate}; a queue brings less"
        case TryKind.ANOTHER_SIDE if one.aspect:
            came = "" if one.share is None else f"{100.0 * one.share:.2g} % of the parts come so"
            tried = f"tried in {counted(one.trials, 'short trial')}" if one.trials else "not tried yet"
            text = f"{side}: {'; '.join(filter(None, (came, tried)))}"
        case TryKind.ANOTHER_SIDE:
            text = "whichever side delivers most"
        case TryKind.ANY_HEADING:
            proved = f", which holds at {rate}" if one.evidence is Evidence.HOLDS else ""
            text = f"{one.aspect} counts at any heading{proved}"
        case TryKind.MORE_DEVICES:
            text = "every kind of device may be used"
        case TryKind.ANY_OUTCOME:
            text = "parts may leave lying or hanging"
        case TryKind.ANY_DIAMETER:
            text = "the bowl may have any diameter"
        case TryKind.ANOTHER_DRIVE:
            text = "a two-axis drive carries parts without throwing them"
        case TryKind.MORE_TRIALS:
            text = f"{one.request.budget} short trials"
        case TryKind.FLATTER_DRIVE:
            keys = listed([f"{key} {text}" for key, text in one.settings])
            text = f"springs make this drive ({keys}), and it holds at {rate}: its draws and queues were run"
        case TryKind.CALMER_DRIVE:
            keys = listed([f"{key} {text}" for key, text in one.settings])
            asked = f"{one.request.target / PER_MINUTE:.3g}/min were asked for"
            text = f"{asked}; by its speed a calmer drive ({keys}) brings about {rate}"
            if one.worst_rate is not None:
                worst = f"{one.worst_rate / PER_MINUTE:.2g}/min" if one.worst_rate > 0.0 else "nothing"
                text += f", at the worst friction {worst}"
            text += "; that is not tried"
    return text
