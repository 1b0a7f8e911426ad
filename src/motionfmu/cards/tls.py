"""TLS for the page and for the link of the cards: certificate and key of files."""

import ssl
from pathlib import Path

from motionfmu.base.errors import InputError


def serving(certificate: Path, key: Path) -> ssl.SSLContext:
    """The server's side."""
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    try:
        # Without an empty password a key that has one would be asked for on the terminal.
        context.load_cert_chain(certificate, key, password="")
    except (OSError, ValueError) as error:
        raise InputError(f"--tls {certificate} {key}: {_told(error)}") from None
    return context


def trusting(certificate: Path) -> ssl.SSLContext:
    """A card's side: this certificate, or one that it signed, is trusted, whatever its name."""
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname = False
    try:
        context.load_verify_locations(certificate)
    except OSError as error:
        raise InputError(f"--tls {certificate}: {_told(error)}") from None
    return context


def refused(error: OSError) -> str:
    """Why a connection was not established."""
    if isinstance(error, ssl.SSLCertVerificationError):
        return f"by TLS its certificate is not trusted ({error.verify_message})"
    if isinstance(error, ssl.SSLError):
        return f"it does not speak TLS ({error.reason or error})"
    if isinstance(error, ConnectionError) and not str(error):
        return "it does not speak TLS (it closed the connection)"
    return error.strerror or str(error)


def _told(error: Exception) -> str:
    if isinstance(error, ssl.SSLError):
        return f"no PEM file, or not of one another ({error.reason or error})"
    return (isinstance(error, OSError) and error.strerror) or str(error)
