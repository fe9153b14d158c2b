#include "evaluate/placement/covariance_model.hpp"
#include "evaluate/placement/placement_input.hpp"
#include <cstdio>
#include <chrono>
using namespace waymark; using namespace waymark::placement;
int main(int, char** argv){
  auto t0=std::chrono::steady_clock::now();
  auto lap=[&](const char*w){std::printf("%s %.3f s\n",w,std::chrono::duration<double>(std::chrono::steady_clock::now()-t0).count());t0=std::chrono::steady_clock::now();};
  auto in=read_placement_input(argv[1],"");
  OccupiedWalls walls{in.image};
  lap("read");
  auto steps=drive_along(in.places,walls,in.config);
  lap("drive");
  ViewModel views{in.config,8};
  std::vector<Sightings> s; std::vector<const Sightings*> p;
  for(auto&m:in.markers) s.push_back(sightings_along(steps,m.map_from_marker,walls,views));
  for(auto&m:s) p.push_back(&m);
  lap("sight");
  for(auto&v:s[1]) std::printf("  step %zu rel x %.2f share %.2f cov %.5f %.5f %.5f raw wall %d focal %.4f\n",v.step,v.view.measurement.base_from_marker.x(),v.view.read_share,std::sqrt(v.view.measurement.covariance(0,0)),std::sqrt(v.view.measurement.covariance(1,1)),std::sqrt(v.view.measurement.covariance(2,2)),v.view.measurement.wall.has_value(),v.view.measurement.focal?v.view.measurement.focal->sigma:-1);
  CovarianceModel model{steps,in.config};
  auto c=model.predict(p);
  lap("predict");
  double next=0;
  for(size_t i=0;i<steps.size();++i){ if(steps[i].travel_m<next) continue; next+=3;
    auto*r=evaluate::covariance_at(in.covariances,in.places[steps[i].scan].t_s);
    std::printf("%5.1f model x %.4f y %.4f t %.5f ",steps[i].travel_m,std::sqrt(c[i](0,0)),std::sqrt(c[i](1,1)),std::sqrt(c[i](2,2)));
    if(r) std::printf(" run x %.4f y %.4f t %.5f",std::sqrt(r->covariance(0,0)),std::sqrt(r->covariance(1,1)),std::sqrt(r->covariance(2,2)));
    std::printf(" deg %d axis %.2f %.2f info %.1f %.1f\n",steps[i].observed.is_degenerate,steps[i].weak_axis.x(),steps[i].weak_axis.y(),std::sqrt(steps[i].observed.information(1,1)),std::sqrt(steps[i].observed.information(2,2)));
  }
}
