#include "session/record_csv.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "support/comma_locale.hpp"

namespace tactus::record_csv_test {
namespace {

std::string row(const SessionRecord& record, Nanoseconds epoch = 0) {
    std::string text;
    append_record_csv(text, record, epoch);
    return text;
}

SessionRecord sample() {
    SessionRecord record;
    record.time = 1'234'567'890;
    record.force = {1.5, -2.25, 0.000000001};
    record.object_position = {0.1, 0.2, -0.3};
    record.hand = {1.0, 2.0, 3.0};
    record.proxy_position = {-1.0, -2.0, -3.0};
    record.proxy_status = 6;
    record.contacts = 2;
    return record;
}

TEST(RecordCsv, BeginsWithTheColumnsOfTheThesis) {
    EXPECT_TRUE(
        record_csv_header().starts_with("time_us,force_x,force_y,force_z,object_x,object_y,object_z,"));
}

TEST(RecordCsv, HasAValueForEachColumn) {
    const std::string header = record_csv_header();
    const std::string text = row(sample());
    EXPECT_EQ(std::count(text.begin(), text.end(), ','), std::count(header.begin(), header.end(), ','));
    EXPECT_TRUE(text.ends_with('\n'));
}

TEST(RecordCsv, WritesMicrosecondsAndNineDecimals) {
    EXPECT_TRUE(
        row(sample()).starts_with("1234567,1.500000000,-2.250000000,0.000000001,0.100000000,0.200000000,"));
}

TEST(RecordCsv, EndsWithTheForceThatWasDisplayedWhenTheTickRanAndWhyItWasCut) {
    SessionRecord record = sample();
    record.displayed = {0.5, 0.0, -8.0};
    record.ran = record.time + 70'000;
    record.cuts = 5;
    EXPECT_TRUE(row(record).ends_with(",0.500000000,0.000000000,-8.000000000,1234637,5\n"));
    EXPECT_TRUE(record_csv_header().ends_with(",displayed_x,displayed_y,displayed_z,ran_us,force_cut\n"));
}

TEST(RecordCsv, CountsFromTheEpoch) {
    EXPECT_TRUE(row(sample(), 1'700'000'000 * nanoseconds_per_second).starts_with("1700000001234567,"));
}

TEST(RecordCsv, WritesNoMinusBeforeZero) {
    SessionRecord record = sample();
    record.force = {-0.0, 0.0, -0.0};
    EXPECT_NE(row(record).find(",0.000000000,0.000000000,0.000000000,0.1"), std::string::npos);
}

TEST(RecordCsv, WritesWhatIsNotANumberAsSuch) {
    SessionRecord record = sample();
    record.force = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e300};
    EXPECT_TRUE(row(record).starts_with("1234567,nan,inf,1e+300,"));
}

TEST(RecordCsv, CitizenWritesTheSameBytesInALocaleWithDecimalCommas) {
    const std::string expected = row(sample());
    const testing::CommaLocale german;
    if (!testing::CommaLocale::is_in_force()) {
        GTEST_SKIP() << "no locale with decimal commas is here, and none can be made";
    }
    EXPECT_EQ(row(sample()), expected);
}

}  // namespace
}  // namespace tactus::record_csv_test
