// Headers of shared records in, headers with their access out: the build runs it before anything is compiled.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "tools/records/records.hpp"

namespace fs = std::filesystem;
using namespace espalier::records;

namespace {

std::string contentsOf(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    if (!in) throw std::runtime_error(path.string() + ": it can't be read");
    return {std::istreambuf_iterator<char>(in), {}};
}

// Leaves a file alone that says the same already, so that nothing is compiled anew for it.
void write(const fs::path& path, const std::string& text) {
    if (fs::exists(path) && contentsOf(path) == text) return;
    fs::create_directories(path.parent_path());
    std::ofstream out(path, std::ios::binary);
    out << text;
    if (!out.flush()) throw std::runtime_error(path.string() + ": it can't be written");
}

}  // namespace

// espalier-records SOURCE OUT HEADER...: headers are paths below SOURCE. For shaders/shared/x.h that asks for
// something, OUT/records/x.h is written.
int main(int argc, char** argv) {
    if (argc < 4) {
        std::fprintf(stderr, "usage: espalier-records SOURCE OUT HEADER...\n");
        return 2;
    }
    try {
        Records all;
        for (int i = 3; i < argc; ++i) readHeader(all, argv[i], contentsOf(fs::path(argv[1]) / argv[i]));
        layOut(all);
        for (const Header& header : all.headers)
            if (!header.wishes.empty())
                write(fs::path(argv[2]) / "records" / fs::path(header.path).filename(), accessOf(all, header));
        return 0;
    } catch (const std::exception& mistake) {
        std::fprintf(stderr, "espalier-records: %s\n", mistake.what());
        return 1;
    }
}
