// Rows of the benchmark: medians, printing, CSV.
#include "tools/bench/bench.hpp"

#include <algorithm>
#include <cstdio>
#include <ctime>

#include "runtime/core/file.hpp"

namespace espalier {

double median(std::vector<double> values) {
    if (values.empty()) return 0;
    std::sort(values.begin(), values.end());
    size_t half = values.size() / 2;
    return values.size() % 2 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

double cpuSeconds(const std::function<void()>& work) {
    const std::clock_t before = std::clock();
    work();
    return double(std::clock() - before) / CLOCKS_PER_SEC;
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
    told_ = true;
    std::printf("%-28s %-34s %12.4g %-9s %-38s %12.4g  ratio %.3f\n", row.name.c_str(), row.figure.c_str(), row.ours,
                row.unit.c_str(), row.otherName.c_str(), row.other, ratio(row));
    std::fflush(stdout);
    rows_.push_back(std::move(row));
}

void Bench::skip(const std::string& name, const std::string& why) {
    told_ = true;
    std::printf("%-28s skipped: %s\n", name.c_str(), why.c_str());
}

Status Bench::writeCsv(const std::string& path) const {
    std::string text = "case,figure,unit,ours,other_name,other,ratio\n";
    // No field holds a comma, so that readers which split at commas are right.
    auto plain = [](std::string field) {
        std::replace(field.begin(), field.end(), ',', ';');
        return field;
    };
    for (const Row& row : rows_) {
        char numbers[3][32];
        std::snprintf(numbers[0], sizeof numbers[0], "%.6g", row.ours);
        std::snprintf(numbers[1], sizeof numbers[1], "%.6g", row.other);
        std::snprintf(numbers[2], sizeof numbers[2], "%.6g", ratio(row));
        text += plain(row.name) + "," + plain(row.figure) + "," + row.unit + "," + numbers[0] + "," +
                plain(row.otherName) + "," + numbers[1] + "," + numbers[2] + "\n";
    }
    return writeFile(path, text);
}

std::string textOf(const std::string& path) {
    Result<std::vector<std::byte>> bytes = readFile(path);
    return bytes ? std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size()) : std::string();
}

}  // namespace espalier
