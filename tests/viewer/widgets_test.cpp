// Labels, tooltips and ranges of the controls.
#include <gtest/gtest.h>

#include <string>

#include "config/settings.hpp"
#include "viewer/gui/widgets.hpp"

namespace tyndall::viewer {
namespace {

TEST(ViewerWidgets, EveryTooltipHasMeaningRangeUnitAndDefault) {
  const config::Settings defaults;
  for (const config::Row& row : config::rows()) {
    const std::string text = tooltip_of(row);
    EXPECT_GT(row.info.doc.size(), 10U) << row.key();
    EXPECT_NE(text.find(row.info.doc), std::string::npos) << row.key();
    const std::string allowed = row.key() + ": " + config::allowed_text(row) + "\n";
    EXPECT_NE(text.find(allowed), std::string::npos) << text;
    const bool number = config::is_real(row.info.type);
    if (number && !row.info.unit.empty() && row.info.unit != "1") {
      EXPECT_NE(allowed.find(" " + std::string(row.info.unit) + "\n"), std::string::npos) << allowed;
    }
    EXPECT_NE(text.find("Default: " + config::value_text(row, defaults)), std::string::npos) << text;
  }
}

TEST(ViewerWidgets, LabelsAreWords) {
  for (const config::Row& row : config::rows()) {
    const std::string label = label_of(row, true);
    EXPECT_EQ(label.find('_'), std::string::npos) << label;
    EXPECT_NE(label.find(' '), std::string::npos) << label << ": one word says too little";
  }
}

TEST(ViewerWidgets, EndsAreThoseOfTheRange) {
  for (const config::Row& row : config::rows()) {
    if (row.info.type == ParamType::string) continue;
    config::Settings least, largest;
    set_to_end(row, least, false);
    set_to_end(row, largest, true);
    EXPECT_NE(config::value_text(row, least), config::value_text(row, largest)) << row.key();
    for (const config::Settings& end : {least, largest}) {
      config::Settings read;
      const std::string text = config::value_text(row, end);
      EXPECT_TRUE(config::set(read, row.key(), text, "test").ok()) << row.key() << "=" << text;
      EXPECT_EQ(config::value_text(row, read), text) << row.key();
    }
  }
}

}  // namespace
}  // namespace tyndall::viewer
