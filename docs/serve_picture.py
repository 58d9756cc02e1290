"""Take a picture of ``feeder serve`` as a browser shows it once a part has been dropped on the page.

Example: python docs/serve_picture.py parts/hexbolt_m8x25.stl docs/serve.png
"""

import sys
import tempfile
import threading
from pathlib import Path

import screenshot
from werkzeug.serving import make_server

from feederscrew.jobs.serving.site import Site

SIZE = (1280, 1650)
PART = "/part-of-the-picture"
DROP = f"""<script>
addEventListener("load", async () => {{
  const bytes = await (await fetch("{PART}")).arrayBuffer(), files = new DataTransfer();
  files.items.add(new File([bytes], "NAME"));
  const input = document.getElementById("file");
  input.files = files.files;
  input.dispatchEvent(new Event("change"));
}});
</script></body>"""


def take(part, picture):
    """Write the picture of the page with a part; the browser's exit status."""
    part = Path(part)
    with tempfile.TemporaryDirectory() as folder:
        site = Site(Path(folder), (sys.executable, "-m", "feederscrew"))

        def with_part(environ, start_response):
            """The site, with a script in its page that drops the part."""
            if environ["PATH_INFO"] == PART:
                start_response("200 OK", [("Content-Type", "application/octet-stream")])
                return [part.read_bytes()]

            def begin(status, headers):
                start_response(status, [header for header in headers if header[0] != "Content-Length"])

            page = b"".join(site(environ, begin))
            return [page.replace(b"</body>", DROP.replace("NAME", part.name).encode())]

        server = make_server("127.0.0.1", 0, with_part, threaded=True)
        site.port = server.server_port
        thread = threading.Thread(target=server.serve_forever, args=(0.05,))
        thread.start()
        try:
            return screenshot.take(site.address, picture, SIZE)
        finally:
            site.close()
            server.shutdown()
            thread.join()
            server.server_close()


if __name__ == "__main__":
    sys.exit(take(*sys.argv[1:3]))
