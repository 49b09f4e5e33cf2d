// Calendar times of recordings, compared with days counted by hand.
#include "tools/replay/text_table.h"

#include <gtest/gtest.h>

#include <ctime>

namespace lcs::replay {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::int64_t kDay_ns = 86'400 * kSecond_ns;

/// Time of midnight of a date, ns.
std::optional<std::int64_t> day(std::string_view date) {
  return calendar_time_in(date, "00:00:00");
}
/// Time of day, ns, on the day whose midnight is 0.
std::optional<std::int64_t> clock(std::string_view text) {
  return calendar_time_in("1970-01-01", text);
}

TEST(CalendarTime, IsNanosecondsSince1970) {
  EXPECT_EQ(calendar_time_in("1970-01-01", "00:00:00"), 0);
  // date -u -d "2011-09-26 13:02:25" +%s
  EXPECT_EQ(calendar_time_in("2011-09-26", "13:02:25.964389445"), 1'317'042'145'964'389'445);
  EXPECT_EQ(calendar_time_in("1969-12-31", "23:59:59.5"), -kSecond_ns / 2);
}

TEST(CalendarTime, OfEveryDayIsWhatTheLibraryOfCSays) {
  std::int64_t expected = -25'567 * kDay_ns;  // 70 years with 17 leap days
  std::tm calendar = {};
  calendar.tm_mday = 1;
  for (; calendar.tm_year < 200; expected += kDay_ns) {
    char date[16];
    std::strftime(date, sizeof date, "%Y-%m-%d", &calendar);
    ASSERT_EQ(day(date), expected) << date;
    ++calendar.tm_mday;
    ::timegm(&calendar);  // carries
  }
  EXPECT_EQ(expected, 47'482 * kDay_ns) << "2100-01-01";
}

TEST(CalendarTime, ALeapYearHasOneMoreDay) {
  EXPECT_EQ(*day("2012-03-01") - *day("2012-02-28"), 2 * kDay_ns);
  EXPECT_EQ(*day("2011-03-01") - *day("2011-02-28"), kDay_ns);
  EXPECT_EQ(*day("2000-03-01") - *day("2000-02-28"), 2 * kDay_ns);
  EXPECT_EQ(*day("1900-03-01") - *day("1900-02-28"), kDay_ns);
}

TEST(CalendarTime, GoesOnOverTheEndsOfMonthsAndYears) {
  const struct {
    const char *last, *first;
  } ends[] = {{"2011-01-31", "2011-02-01"}, {"2011-04-30", "2011-05-01"},
              {"2012-02-29", "2012-03-01"}, {"2011-09-30", "2011-10-01"},
              {"2011-12-31", "2012-01-01"}, {"1999-12-31", "2000-01-01"}};
  for (const auto& [last, first] : ends) {
    const auto before = calendar_time_in(last, "23:59:59.999999999");
    ASSERT_TRUE(before) << last;
    EXPECT_EQ(*day(first) - *before, 1) << last;
  }
}

TEST(CalendarTime, KeepsFractionsToTheNanosecond) {
  EXPECT_EQ(clock("00:00:00.000000001"), 1);
  EXPECT_EQ(clock("00:00:59.999999999"), 59'999'999'999);
  EXPECT_EQ(clock("00:00:07.25"), 7'250'000'000);
  EXPECT_EQ(clock("00:00:00.0000000006"), 1) << "to the nearest";
  EXPECT_EQ(clock("23:59:59"), kDay_ns - kSecond_ns);
}

TEST(CalendarTime, ALeapSecondIsTheNextMinutesFirst) {
  EXPECT_EQ(calendar_time_in("2016-12-31", "23:59:60.5"), *day("2017-01-01") + kSecond_ns / 2);
}

TEST(CalendarTime, DaysThatAreNoneAreRefused) {
  for (const char* date : {"2011-02-29",
                           "2012-02-30",
                           "1900-02-29",
                           "2011-04-31",
                           "2011-09-31",
                           "2011-01-32",
                           "2011-00-10",
                           "2011-13-10",
                           "2011-10-00",
                           "1899-12-31",
                           "2100-01-01",
                           "-2011-01-01",
                           "2011",
                           "2011-09",
                           "2011-09-",
                           "2011-09-26-01",
                           "2011-09-26x",
                           "2011/09/26",
                           "11-09-26",
                           "2011- 9-26",
                           "99999999999-01-01",
                           "",
                           "nan-01-01"}) {
    EXPECT_EQ(day(date), std::nullopt) << date;
  }
}

TEST(CalendarTime, TimesThatAreNoneAreRefused) {
  for (const char* text : {"24:00:00", "-1:00:00", "12:60:00", "12:-1:00", "12:00:61", "12:00:-0.1",
                           "12:00:nan", "12:00:inf", "12:00", "12:00:", "12:00:00:00", "12:00:0x10",
                           "12:00:01s", "12.00.00", "", "1e9:00:00"}) {
    EXPECT_EQ(clock(text), std::nullopt) << text;
  }
}

}  // namespace
}  // namespace lcs::replay
