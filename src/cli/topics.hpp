#pragma once

#include <string>
#include <vector>

namespace slideway {

/// What `slideway help TOPIC` explains beside the commands.
const std::vector<std::string>& topics();

/// REQUIRES one of topics(). In at most 80 columns.
std::string topic_text(const std::string& topic);

}  // namespace slideway
