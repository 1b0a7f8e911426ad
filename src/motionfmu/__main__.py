"""``python -m motionfmu`` is the console command."""

from motionfmu.cli import main

if __name__ == "__main__":
    main()
