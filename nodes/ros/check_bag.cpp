/// check_bag: says whether bags can be replayed, and what to do where not.
#include <CLI/CLI.hpp>
#include <iostream>

#include "ros/bag_check.hpp"

int main(int argc, char** argv) {
  try {
    std::vector<std::string> bags;
    CLI::App app(
        "Says whether bags can be replayed through the chain. Exit: 0 all can, 1 one cannot, 2 usage.");
    app.add_option("BAG", bags, "bags")->required();
    try {
      app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      return app.exit(error) == 0 ? 0 : 2;
    }
    bool all = true;
    for (const std::string& bag : bags) {
      const tensegric_fit::node::BagCheck check = tensegric_fit::node::check_bag(bag);
      std::cout << to_text(check, bag);
      all = all && check.can_be_replayed();
    }
    return all ? 0 : 1;
  } catch (const std::exception& error) {
    std::cerr << "check_bag: " << error.what() << '\n';
    return 1;
  }
}
