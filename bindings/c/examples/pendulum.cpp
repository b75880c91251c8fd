// The same lab in C++: handles that free themselves, errors as exceptions.
//     pendulum specs/lessons/02-bounce-and-swing.md specs/models
#include "labspec.h"
#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace labspec {

inline void check(labspec_status status)
{
    if (status != LABSPEC_OK) throw std::runtime_error(labspec_last_error());
}

struct Free {
    void operator()(labspec_lab *lab) const { labspec_lab_free(lab); }
};

class Lab {
public:
    Lab(const std::string &path, const std::string &lesson, const std::string &address, const std::string &folder)
    {
        labspec_model_source models{};
        models.struct_size = sizeof models;
        models.folder = folder.c_str();
        labspec_lab *opened = nullptr;
        check(labspec_lab_open_lesson(path.c_str(), lesson.c_str(), address.c_str(), &models, &opened));
        lab.reset(opened);
    }
    void set(const std::string &label, double value) { check(labspec_lab_set_number(lab.get(), label.c_str(), value)); }
    void step(std::size_t steps) { check(labspec_lab_step(lab.get(), steps)); }
    double time() const { double t = 0; check(labspec_lab_time(lab.get(), &t)); return t; }
    std::vector<double> numbers() const
    {
        std::size_t count = 0;
        check(labspec_lab_numbers(lab.get(), nullptr, 0, &count));
        std::vector<double> all(count);
        check(labspec_lab_numbers(lab.get(), all.data(), count, &count));
        return all;
    }

private:
    std::unique_ptr<labspec_lab, Free> lab;
};

} // namespace labspec

int main(int argc, char **argv)
{
    if (argc != 3) return 2;
    try {
        std::ifstream file(argv[1], std::ios::binary);
        const std::string lesson{std::istreambuf_iterator<char>(file), {}};
        labspec::Lab lab(argv[1], lesson, "#2", argv[2]);
        lab.set("start", 1.5);
        for (int i = 0; i < 4; i++) {
            const auto numbers = lab.numbers();
            std::printf("%.3f s: angle %.17g rad, height %.3f m\n", lab.time(), numbers.at(0), numbers.at(2));
            lab.step(100);
        }
        lab.set("strat", 1);
    } catch (const std::exception &e) {
        std::printf("%s\n", e.what());
    }
    return 0;
}
