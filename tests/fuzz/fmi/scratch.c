#define _XOPEN_SOURCE 700
#include "scratch.h"

#include <dirent.h>
#include <ftw.h>
#include <sys/stat.h>
#include <unistd.h>

#include "holds.h"

static char in_memory[] = "/dev/shm/fuzz_fmi_XXXXXX", on_disk[] = "/tmp/fuzz_fmi_XXXXXX";
static char *folder;

const char *const scratch_names[SCRATCH_NAMES] = {
    "good.ngc",   "table.csv",    "out",      "",        "good.ngc",    "bad.ngc", "link",
    "hard",       "pipe",         "sub",      "sub/out", "missing/out", "zero",    "gone",
    "./good.ngc", "out.real.npy", "table.csv"
};

const char *const scratch_texts[SCRATCH_TEXTS] = {
    "state",
    "state",
    "G1 X0.2 F3000",
    "G0 X0 Y0\nG64 P0.1\nG1 X0.1 F3000\nX0.2 Y0.1\nM3 S100",
    "G91 G1 X1 F60000\nG2 I1\nM30",
    "G10 L20 P1 X0\n#1=[2*3]\nG1 X#1\nQ",
    "o1 while [1]\no1 endwhile",
    "M2"
};

static const struct {
    const char *name, *text;
    size_t size;
} files[] = {
#define TEXT(s) s, sizeof s - 1
    { "good.ngc", TEXT("G90 G0 X0 Y0\nG64 P0.1\nG1 X0.2 F3000\nG2 X0.3 Y0.1 I0.1 J0\n"
                       "M62 P1\nG1 Y1 Z0.1\nX0 M3 S500\nG4 P0.01\nM2\n") },
    { "bad.ngc", TEXT("G1 X1\nG1 X2 Y3 I4 Q\xff\n") },
    { "table.csv", TEXT("axis,interval,home\n1,800,10\n2,8000,0\naxis,index,forward,backward\n"
                        "1,10,3,-3\n1,11,5,-5\n2,0,100,-100\n") },
    { "zero", TEXT("axis,interval,home\n\0\nG1 X1\n") }
};

static int take(const char *path, const struct stat *s, int type, struct FTW *place)
{
    (void)s, (void)type;
    return place->level > 0 ? remove(path) : 0;
}

static void empty(void)
{
    HOLDS(nftw(folder, take, 8, FTW_DEPTH | FTW_PHYS) == 0);
}

static void end(void)
{
    empty();
    rmdir(folder);
}

void scratch_open(void)
{
    if (!folder) {
        folder = mkdtemp(in_memory);
        folder = folder ? folder : mkdtemp(on_disk);
        HOLDS(folder);
        atexit(end);
    }
    HOLDS(chdir(folder) == 0);
    empty();
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        FILE *f = fopen(files[i].name, "wb");
        HOLDS(f && fwrite(files[i].text, 1, files[i].size, f) == files[i].size && !fclose(f));
    }
    HOLDS(mkdir("sub", 0777) == 0 && mkfifo("pipe", 0666) == 0);
    HOLDS(symlink("good.ngc", "link") == 0 && link("good.ngc", "hard") == 0);
}

void scratch_state(const char *bytes, size_t size)
{
    FILE *f = fopen("state", "wb"); /* none where an FMU has made a folder of that name */
    HOLDS(!f || (fwrite(bytes, 1, size, f) == size && !fclose(f)));
}

void scratch_check(void)
{
    struct stat s;
    HOLDS(lstat("pipe", &s) == 0 && S_ISFIFO(s.st_mode));
    HOLDS(lstat("link", &s) == 0 && S_ISLNK(s.st_mode));
    HOLDS(lstat("sub", &s) == 0 && S_ISDIR(s.st_mode));
    DIR *d = opendir(".");
    HOLDS(d);
    for (struct dirent *e; (e = readdir(d)) != NULL;) {
        HOLDS(!strstr(e->d_name, ".part") && !strstr(e->d_name, ".old"));
    }
    closedir(d);
}
