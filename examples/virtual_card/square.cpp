// The same library from C++: a square with exact stops and as continuous path, on cards of their own.
//
//     c++ -O2 square.cpp $(pkg-config --cflags --libs motionfmu-station) -o square
//     ./square
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <motionfmu/short_names.h>
#include <motionfmu/station.h>

struct Corner {
    double x, y; // [mm]
};

// Time of the square [s] at a feed of 20 mm/s.
static double square(bool continuous)
{
    const std::vector<Corner> corners{{10, 0}, {10, 10}, {0, 10}, {0, 0}};
    const auto station = std::make_unique<struct station>();
    station_config config = station_defaults();
    if (station_start(station.get(), &config) != STATION_OK)
        throw std::runtime_error("the card does not start");
    mcc *m = &station->pc.mcc;
    MCC_set_fspd(m, 20);
    if (continuous)
        MCC_enable_quit(m);
    for (const Corner &c : corners) {
        const double target[AXES] = {c.x, c.y};
        if (const int code = MCC_line(m, target); code < 0)
            throw std::runtime_error("MCC_line: " + std::to_string(code));
    }
    station_reading r;
    do {
        station_run(station.get(), station->clock + STATION_HZ / 100, nullptr);
        station_read(station.get(), &r);
    } while (!r.stopped);
    return static_cast<double>(r.clock) / STATION_HZ;
}

int main()
{
    const double exact = square(false), path = square(true);
    std::printf("exact stops %.2f s, continuous path %.2f s\n", exact, path);
}
