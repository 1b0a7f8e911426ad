"""Make the site: stage its source, then call Sphinx, whose warnings are errors.

python docs/site/build.py build/site
"""

import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path.insert(0, str(HERE))

from site_pages import sections, staging  # noqa: E402


def build(target: Path) -> int:
    """Build the site into a folder; Sphinx's status."""
    source = target.with_name(f"{target.name}.source")
    shutil.rmtree(source, ignore_errors=True)
    staged = staging.stage(ROOT, source)
    sections.write_all(staged)
    shutil.rmtree(target, ignore_errors=True)
    options = ["-b", "html", "-W", "--keep-going", "-c", str(HERE)]
    options += ["-d", f"{target}.doctrees", "-D", f"html_extra_path={source / 'extra'}"]
    return subprocess.run([sys.executable, "-m", "sphinx", *options, source, target]).returncode


if __name__ == "__main__":
    sys.exit(build(Path(sys.argv[1]).resolve()))
