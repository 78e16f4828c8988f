/// history: a customer's earlier scans and fits, to be opened and compared.
#include <CLI/CLI.hpp>
#include <iostream>

#include "files/owner_only.hpp"
#include "files/whole_folder.hpp"
#include "fit/history.hpp"
#include "fit/parsed_line.hpp"
#include "fit/result_documents.hpp"
#include "geometry/status.hpp"

namespace {

using namespace tensegric_fit;

int compare(const std::vector<std::string>& folders, const std::string& customer,
            const std::vector<std::size_t>& pair, const std::string& out) {
  const std::vector<fit::Visit> visits = fit::find_visits(folders, customer);
  if (customer.empty()) {
    std::cout << fit::customers_text(visits);
    return 0;
  }
  if (visits.empty()) {
    std::cerr << "history: no visit of customer " << customer << '\n';
    return 1;
  }
  const std::size_t from = pair.empty() ? 1 : pair[0], to = pair.empty() ? visits.size() : pair[1];
  if (from < 1 || to < 1 || from > visits.size() || to > visits.size()) {
    std::cerr << "history: --compare: there are visits 1 to " << visits.size() << '\n';
    return 2;
  }
  std::cout << fit::visits_text(visits, from - 1, to - 1);
  if (out.empty()) return 0;
  std::error_code not_there;
  for (const fit::Visit& visit : visits)
    for (const char* document : fit::kVisitDocuments)
      if (std::filesystem::equivalent(out, visit.folder / document, not_there)) {
        std::cerr << "history: --out: the page would overwrite " << out << '\n';
        return 2;
      }
  const std::string page = fit::visits_page(visits, from - 1, to - 1, out);
  files::write_whole_file(out, page);
  std::cout << out << '\n';
  return 0;
}

int run(int argc, char** argv) {
  std::vector<std::string> folders;
  std::string customer, out;
  std::vector<std::size_t> pair;
  CLI::App app(
      "A customer's earlier scans and fits, from the folders that exports and `fit --customer` wrote. Exit: "
      "0 done, "
      "1 there is none or the page cannot be written, 2 usage, 3 a folder is refused.");
  app.add_option("DIR", folders, "Folders that hold them, at any depth")->required();
  auto* const whose = app.add_option("--customer", customer, "The shop's own id; none: who was here");
  app.add_option("--compare", pair, "Two visits by number; default: first and last")
      ->expected(2)
      ->needs(whose);
  app.add_option("--out", out, "Page.html with tables, outlines and links")->needs(whose);
  if (const auto code = fit::parsed(app, argc, argv, std::cerr, [] {})) return *code;
  if (!out.empty() && fit::lies_in_export(std::filesystem::absolute(out).parent_path())) {
    std::cerr << "history: --out: " << out << " would lie in an export, which takes no other files\n";
    return 2;
  }
  return compare(folders, customer, pair, out);
}

}  // namespace

int main(int argc, char** argv) {
  files::owner_only();
  try {
    return run(argc, argv);
  } catch (const geometry::Refusal& refusal) {
    std::cerr << "history: " << refusal.code() << ": " << refusal.what() << '\n';
    return refusal.code() == geometry::refusal::kCannotWrite ? 1 : 3;
  } catch (const std::exception& error) {
    std::cerr << "history: " << error.what() << '\n';
    return 1;
  }
}
