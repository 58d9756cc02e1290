"""What of the devices a solid with one bank can be made of."""

from dataclasses import replace

from feederscrew.errors import FeederError


def banked(track, devices, every):
    """Return the track with the bank that the first devices give it from its entry on.

    Parameters
    ----------
    track : Track
    devices : sequence of Device
    every : sequence of Orientation
        Of the part on that track.

    Returns
    -------
    Track

    Raises
    ------
    FeederError
        If a device is a groove, changes the bank of the track further on, or leads it on beside a ledge.
    """
    entry = True
    for device in devices:
        if not device.placed:
            continue
        for slope in device.standing(track, every).slopes:
            if slope.wall:
                raise _refused(device, "is a V, which a solid does not have")
            if slope.bank is not None and not entry:
                raise _refused(device, "changes the bank of the track, and a solid has one bank")
            track = track if slope.bank is None else replace(track, bank=slope.bank)
        entry = entry and device.leans
        lower = device.lower(every)
        if lower is not None and lower[1] > 0.0:
            raise _refused(device, "leads to a lower track beside it, which a solid does not have")
    return track


def _refused(device, what):
    return FeederError(f"devices: {device.label}", what, "leave it out of the bowl file of the solid")
