#pragma once
// What the compiled benchmarks share: a clock, their options, and one table that is printed and written.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/vec3.hpp"

namespace peclet::benchmarks {

/// Best wall and processor milliseconds of several runs.
class Best {
 public:
  template <class Work>
  void add(const Work& work) {
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t processor_start = std::clock();
    work();
    const std::chrono::duration<double> wall_time = std::chrono::steady_clock::now() - start;
    wall = std::min(wall, 1e3 * wall_time.count());
    processor =
        std::min(processor, 1e3 * static_cast<double>(std::clock() - processor_start) / CLOCKS_PER_SEC);
  }

  double wall = 1e30, processor = 1e30;
};

/// Distance to a sphere in a periodic box of unit cells.
inline Real sphere_distance(Vec3 x, Vec3 centre, Real radius, const Int3& cells) {
  Vec3 r = x - centre;
  for (int a = 0; a < 3; ++a) r[a] -= cells[a] * std::round(r[a] / cells[a]);
  return norm(r) - radius;
}

/// [part of the names of the cases to run] [--output FILE]
struct Options {
  std::string wanted, output;

  Options(int argc, char** argv) {
    for (int n = 1; n < argc; ++n) {
      const std::string word = argv[n];
      if (word == "--output" && n + 1 < argc)
        output = argv[++n];
      else if (word.rfind("--kokkos", 0) != 0)
        wanted = word;
    }
  }
  bool wants(const std::string& name) const { return name.find(wanted) != std::string::npos; }
};

using Cell = std::variant<std::string, double>;

class Table {
 public:
  Table(std::string name, std::vector<std::string> columns)
      : name_(std::move(name)), columns_(std::move(columns)) {}

  /// What stands first: ratios and extremes.
  void add_first(std::vector<Cell> row) { rows_.insert(rows_.begin() + first_++, std::move(row)); }
  void add(std::vector<Cell> row) { rows_.push_back(std::move(row)); }

  /// Prints the table and writes it, as CSV or JSON according to the ending; the exit status.
  int finish(const Options& options) const {
    if (rows_.empty()) {
      std::fprintf(stderr, "bench_%s: expected part of the name of a case, found %s\n", name_.c_str(),
                   options.wanted.c_str());
      return 1;
    }
    print();
    if (options.output.empty()) return 0;
    std::ofstream file(options.output);
    const bool is_csv =
        options.output.size() > 4 && options.output.substr(options.output.size() - 4) == ".csv";
    is_csv ? write_csv(file) : write_json(file);
    if (!file.flush())
      std::fprintf(stderr, "bench_%s: cannot write %s\n", name_.c_str(), options.output.c_str());
    return file ? 0 : 1;
  }

 private:
  static std::string text_of(const Cell& cell) {
    if (const auto* text = std::get_if<std::string>(&cell)) return *text;
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", std::get<double>(cell));
    return text;
  }

  void print() const {
    std::vector<std::size_t> widths;
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      widths.push_back(columns_[c].size());
      for (const auto& row : rows_) widths[c] = std::max(widths[c], text_of(row[c]).size());
    }
    const auto pad = [&](std::size_t c, const std::string& text) {
      std::printf(c ? "  %*s" : "%-*s", static_cast<int>(widths[c]), text.c_str());
    };
    for (std::size_t c = 0; c < columns_.size(); ++c) pad(c, columns_[c]);
    for (const auto& row : rows_) {
      std::printf("\n");
      for (std::size_t c = 0; c < row.size(); ++c) pad(c, text_of(row[c]));
    }
    std::printf("\n");
  }

  /// The cells as they are written: texts in quotes.
  static std::string quoted(const Cell& cell) {
    const std::string text = text_of(cell);
    const bool is_number = std::holds_alternative<double>(cell) && std::isfinite(std::get<double>(cell));
    return is_number ? text : "\"" + text + "\"";
  }

  static void write_row(std::ofstream& file, const std::vector<Cell>& row, const char* begin,
                        const char* end) {
    file << begin;
    for (std::size_t c = 0; c < row.size(); ++c) file << (c ? "," : "") << quoted(row[c]);
    file << end;
  }

  std::vector<Cell> header() const { return {columns_.begin(), columns_.end()}; }

  void write_csv(std::ofstream& file) const {
    write_row(file, header(), "", "\n");
    for (const auto& row : rows_) write_row(file, row, "", "\n");
  }

  void write_json(std::ofstream& file) const {
    file << "{\"name\": \"" << name_ << "\",\n";
    write_row(file, header(), " \"columns\": [", "],\n \"rows\": [\n");
    for (std::size_t r = 0; r < rows_.size(); ++r)
      write_row(file, rows_[r], "  [", r + 1 < rows_.size() ? "],\n" : "]\n");
    file << " ]}\n";
  }

  std::string name_;
  std::vector<std::string> columns_;
  std::vector<std::vector<Cell>> rows_;
  std::ptrdiff_t first_ = 0;
};

}  // namespace peclet::benchmarks
