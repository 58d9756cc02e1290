"""``feeder serve``."""

import sys
import tempfile
import webbrowser
from pathlib import Path

import click

from feederscrew.base.errors import MissingPackage
from feederscrew_cli import grouped, options
from feederscrew_cli.interrupt import end_within, hold_interrupts

FEEDER_CALL = (sys.executable, "-c", "from feederscrew_cli.main import feeder; feeder()")
INSTALL_SERVE = "pip install 'feederscrew[serve]'"
END_WITHIN_S = 40.0  # after Ctrl-C or SIGTERM, a running design with it


@grouped.command(short_help="The main job in a browser, on this machine alone.")
@options.whole("--port", 0, 65535, "Port on 127.0.0.1.  [default: any that is free]", default=0)
@options.flag("--browser", "Open the page in the browser of this machine.")
@options.QUIET
def serve(port: int, browser: bool, quiet: bool) -> None:
    """Example: feeder serve

    Show the main job as a page on 127.0.0.1. Drop a part file, see its resting aspects turn, and click the
    one on which parts must leave. Choose rate, material, outcome, what may be used, machine and bowl at hand.
    Start a design, stop it, read its page and download its folder. What falls short has the next steps as
    buttons. The designs of the run are listed, each with the name of its part.

    It prints the address with a token of this run; without the token nobody else on the machine is answered.
    Nothing leaves the machine. One design runs at a time. What is uploaded and computed lies in a temporary
    folder, which is removed at the end: download what you keep. Ctrl-C ends it. It needs the extra serve.
    """
    with hold_interrupts():
        try:
            import werkzeug.serving  # noqa: F401
        except ImportError:
            raise MissingPackage("serve", "needs werkzeug, which is not installed", INSTALL_SERVE) from None
        from feederscrew.jobs.serving.designs import Guard
        from feederscrew.jobs.serving.server import BoundedServer
        from feederscrew.jobs.serving.site import Site

    with (
        end_within(END_WITHIN_S),
        tempfile.TemporaryDirectory(prefix="feeder.", ignore_cleanup_errors=True) as folder,
    ):
        site = Site(Path(folder), FEEDER_CALL)
        server = BoundedServer(site, port)
        try:
            site.guard = Guard(Path(folder))
            click.echo(site.address)
            if not quiet:
                click.echo("Open this address in a browser on this machine; Ctrl-C ends it.", err=True)
            if browser:
                webbrowser.open(site.address)
            server.serve_forever(poll_interval=0.2)
            raise KeyboardInterrupt  # werkzeug has taken it
        finally:
            site.close()
            server.server_close()
