#pragma once

// One row a figure: ours, the other side measured in the same run, and the ratio ours / other.

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "runtime/core/result.hpp"

namespace espalier {

struct Row {
    std::string name;    // "growth/seeds-64"
    std::string figure;  // "nodes per second"
    std::string unit;    // "nodes/s"
    double ours = 0;
    std::string otherName;  // what the other side is
    double other = 0;
};

struct BenchOptions {
    std::string filter;      // cases whose name contains it; empty: all
    std::string dataFolder;  // further models; cases that need them say when they are skipped
    std::string contentFolder;
    std::string modulesFolder;  // npm's, with watlas in it: the other side of bake/atlas
    int repeats = 7;
};

class Bench {
  public:
    explicit Bench(BenchOptions options) : options_(std::move(options)) {}
    const BenchOptions& options() const { return options_; }
    bool wants(const std::string& name) const { return name.find(options_.filter) != std::string::npos; }
    // Prints the row at once and keeps it for the CSV.
    void add(Row row);
    void skip(const std::string& name, const std::string& why);
    bool told() const { return told_; }  // a row, or why there is none
    Status writeCsv(const std::string& path) const;

  private:
    BenchOptions options_;
    std::vector<Row> rows_;
    bool told_ = false;
};

// Median seconds of `repeats` runs of each, taken in turn (a, b, a, b, …) so that both meet the same noise.
// Each is run once beforehand.
struct Pair {
    double a = 0, b = 0;
};
Pair medianSeconds(int repeats, const std::function<void()>& a, const std::function<void()>& b);

double seconds(const std::function<void()>& work);
// CPU time of all threads: what a machine that others use measures alike.
double cpuSeconds(const std::function<void()>& work);
double median(std::vector<double> values);
// A file's text; empty where there is none.
std::string textOf(const std::string& path);

void growthCases(Bench& bench);
void fieldCases(Bench& bench);
void patternCases(Bench& bench);
void graphCases(Bench& bench);
void editCases(Bench& bench);
void emitCases(Bench& bench);
void exportCases(Bench& bench);
void frameCases(Bench& bench);
void placeCases(Bench& bench);
void bakeCases(Bench& bench);
void atlasCases(Bench& bench);
void contactCases(Bench& bench);
void moveCases(Bench& bench);
void paintCases(Bench& bench);
void surfaceCases(Bench& bench);
void loadCases(Bench& bench);
void lodCases(Bench& bench);
void roofStructureCases(Bench& bench);
void roofGrowthCases(Bench& bench);

}  // namespace espalier
