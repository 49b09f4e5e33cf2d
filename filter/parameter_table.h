/// \file
/// What is known of each parameter beside its value. The rows of what only the paper's rules ask
/// for are in `paper/`, the others in `parameters.cpp`.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "filter/parameters.h"

namespace lcs {

/// A value that is one of a few words.
struct Choice {
  int (*get)(const Parameters&);
  void (*put)(Parameters&, int);
  std::vector<std::string> words;
};

template <typename T>
using Field = T& (*)(Parameters&);

/// The rules that ask for a parameter, each by the choice that names it; none: it is always asked
/// for.
using AskedBy = std::vector<Rule>;

struct Entry {
  std::string key;
  std::string symbol;
  std::string unit;  // "deg" fields are radians in the struct
  double min = 0, max = 0;
  std::variant<Field<double>, Field<int>, Field<bool>, Choice> field;
  AskedBy asked_by = {};
};

// A captureless lambda that names the member: a table reads as a list of fields.
#define LCS_FIELD(type, member) Field<type>([](Parameters& p) -> type& { return p.member; })
#define LCS_REAL(member) LCS_FIELD(double, member)
#define LCS_CHOICE(type, member, ...)                                                             \
  Choice {                                                                                        \
    [](const Parameters& p) { return static_cast<int>(p.member); },                               \
        [](Parameters& p, int i) { p.member = static_cast<type>(i); }, std::vector<std::string> { \
      __VA_ARGS__                                                                                 \
    }                                                                                             \
  }

/// Of the parameters that only the paper's rules ask for.
std::vector<Entry> paper_entries();

}  // namespace lcs
