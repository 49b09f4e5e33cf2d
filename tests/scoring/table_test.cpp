/// Tables of figures in each format, by their own readers' rules.
#include "tools/scoring/table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>

namespace lcs::scoring {
namespace {

const FigureTable kTable{{{"scenario", "scenario"}, {"f1", "F1"}, {"wrong", "wrong (per frame)"}},
                         {{"near", TableFigure{0.5, 0.0625}, TableFigure{1234.5, {}, 1}},
                          {"far, \"very\"", TableFigure{-0.25, {}, 2, true}, {}},
                          {"a|b_1 & 5 %", {}, TableFigure{2, 1.25, 1}}}};

TEST(FigureTables, AsTextAlignNumbersBelowTheirHeadings) {
  EXPECT_EQ(table_text(kTable, Format::text),
            "scenario        F1      wrong (per frame)\n"
            "near          0.50±.06         1234.5\n"
            "far, \"very\"  -0.25                  -\n"
            "a|b_1 & 5 %      -                2.0±1.2\n");
}

TEST(FigureTables, AsTextKeepTo120ColumnsByGivingALongNameALineOfItsOwn) {
  FigureTable wide{{{"name", "name"}}, {{std::string(100, 'n')}}};
  for (int i = 0; i < 12; ++i) {
    wide.columns.push_back({"k", "k"});
    wide.rows[0].emplace_back(TableFigure{0.5, 0.25});
  }
  std::istringstream lines(table_text(wide, Format::text));
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    EXPECT_LE(std::ranges::count_if(line, [](char c) { return (c & 0xC0) != 0x80; }), 120) << line;
  }
  EXPECT_EQ(count, 3) << "the heading, the name, and its figures";
}

TEST(FigureTables, AsCsvHaveAllDigitsAndHalvesInAColumnOfTheirOwn) {
  EXPECT_EQ(table_text(kTable, Format::csv),
            "scenario,f1,f1_half,wrong,wrong_half\n"
            "near,0.5,0.0625,1234.5,\n"
            "\"far, \"\"very\"\"\",-0.25,,,\n"
            "a|b_1 & 5 %,,,2,1.25\n");
}

TEST(FigureTables, AsMarkdownEscapeTheBarOfACell) {
  EXPECT_EQ(table_text(kTable, Format::markdown),
            "| scenario | F1 | wrong (per frame) |\n"
            "|---|---|---|\n"
            "| near | 0.50±.06 | 1234.5 |\n"
            "| far, \"very\" | -0.25 | - |\n"
            "| a\\|b_1 & 5 % | - | 2.0±1.2 |\n");
}

TEST(FigureTables, AsLatexEscapeItsSpecialCharacters) {
  EXPECT_EQ(table_text(kTable, Format::latex),
            "\\begin{tabular}{lrr}\n\\toprule\n"
            "scenario & F1 & wrong (per frame) \\\\\n\\midrule\n"
            "near & $0.50 \\pm .06$ & $1234.5$ \\\\\n"
            "far, \"very\" & $-0.25$ & - \\\\\n"
            "a$|$b\\_1 \\& 5 \\% & - & $2.0 \\pm 1.2$ \\\\\n"
            "\\bottomrule\n\\end{tabular}\n");
}

TEST(FigureTables, RefuseAnUnknownFormatByNamingThoseThatAreThere) {
  EXPECT_EQ(format_of("csv"), Format::csv);
  try {
    format_of("tex");
    ADD_FAILURE() << "no refusal";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "--format is 'tex'; it takes text, markdown, csv, latex");
  }
}

}  // namespace
}  // namespace lcs::scoring
