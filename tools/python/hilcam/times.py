"""Times as scenarios write them, in UTC, and as commands have them, in nanoseconds of TAI (docs/conventions.md)."""
import datetime
from typing import Tuple

# TAI - UTC in whole seconds from these days on (IERS Bulletin C; none was announced after 2017 by 2026).
LEAP_SECONDS: Tuple[Tuple[str, int], ...] = (
    ("1972-01-01", 10), ("1972-07-01", 11), ("1973-01-01", 12), ("1974-01-01", 13), ("1975-01-01", 14), ("1976-01-01", 15),
    ("1977-01-01", 16), ("1978-01-01", 17), ("1979-01-01", 18), ("1980-01-01", 19), ("1981-07-01", 20), ("1982-07-01", 21),
    ("1983-07-01", 22), ("1985-07-01", 23), ("1988-01-01", 24), ("1990-01-01", 25), ("1991-01-01", 26), ("1992-07-01", 27),
    ("1993-07-01", 28), ("1994-07-01", 29), ("1996-01-01", 30), ("1997-07-01", 31), ("1999-01-01", 32), ("2006-01-01", 33),
    ("2009-01-01", 34), ("2012-07-01", 35), ("2015-07-01", 36), ("2017-01-01", 37))
_UTC = datetime.timezone.utc
_EPOCH = datetime.datetime(1970, 1, 1, tzinfo=_UTC)
_STEPS = [(datetime.datetime.fromisoformat(day).replace(tzinfo=_UTC), step) for day, step in LEAP_SECONDS]


def _nanoseconds(span: datetime.timedelta) -> int:
    return (span.days * 86400 + span.seconds) * 10**9 + span.microseconds * 1000


def tai_ns_of_utc(utc: str) -> int:
    """Nanoseconds since 1970-01-01T00:00:00 TAI of a time as scenarios have it, 2026-03-20T12:00:00Z, from 1972 on."""
    when = datetime.datetime.fromisoformat(utc.replace("Z", "+00:00"))
    if when.tzinfo is None:
        when = when.replace(tzinfo=_UTC)
    steps = [step for day, step in _STEPS if day <= when]
    if not steps:
        raise ValueError(f"{utc}: accepted: 1972-01-01 or later")
    return _nanoseconds(when - _EPOCH) + steps[-1] * 10**9


def utc_of_tai_ns(tai_ns: int) -> datetime.datetime:
    """The same back, to the microsecond. A leap second itself is the first second after it."""
    for day, step in reversed(_STEPS):
        if tai_ns >= _nanoseconds(day - _EPOCH) + step * 10**9:
            return _EPOCH + datetime.timedelta(microseconds=(tai_ns - step * 10**9) // 1000)
    raise ValueError(f"{tai_ns}: accepted: 1972-01-01 or later")
