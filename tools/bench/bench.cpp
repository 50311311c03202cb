// Rows of the benchmark: medians, printing, CSV.
#include "tools/bench/bench.hpp"

#include <algorithm>
#include <cstdio>

namespace espalier {

double median(std::vector<double> values) {
    if (values.empty()) return 0;
    std::sort(values.begin(), values.end());
    size_t half = values.size() / 2;
    return values.size() % 2 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

double seconds(const std::function<void()>& work) {
    auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

Pair medianSeconds(int repeats, const std::function<void()>& a, const std::function<void()>& b) {
    a();
    b();
    std::vector<double> as, bs;
    for (int i = 0; i < repeats; ++i) {
        as.push_back(seconds(a));
        bs.push_back(seconds(b));
    }
    return {median(as), median(bs)};
}

static double ratio(const Row& row) {
    return row.other != 0 ? row.ours / row.other : 0;
}

void Bench::add(Row row) {
    std::printf("%-28s %-34s %12.4g %-9s %-38s %12.4g  ratio %.3f\n", row.name.c_str(), row.figure.c_str(), row.ours,
                row.unit.c_str(), row.otherName.c_str(), row.other, ratio(row));
    std::fflush(stdout);
    rows_.push_back(std::move(row));
}

void Bench::skip(const std::string& name, const std::string& why) const {
    std::printf("%-28s skipped: %s\n", name.c_str(), why.c_str());
}

bool Bench::writeCsv(const std::string& path) const {
    std::FILE* file = std::fopen(path.c_str(), "w");
    if (!file) return false;
    std::fprintf(file, "case,figure,unit,ours,other_name,other,ratio\n");
    for (const Row& row : rows_)
        std::fprintf(file, "%s,%s,%s,%.6g,%s,%.6g,%.6g\n", row.name.c_str(), row.figure.c_str(), row.unit.c_str(),
                     row.ours, row.otherName.c_str(), row.other, ratio(row));
    bool written = std::ferror(file) == 0;
    return std::fclose(file) == 0 && written;
}

}  // namespace espalier
