#include "ccd/cuda/exact_stages.hpp"
#include "ccd/cuda/method_stages.hpp"
#include <vector>
#include <ccd/method.hpp>
#include <cstdio>
#include <random>
using namespace ccd; using namespace ccd::cuda;
int main(){
  std::mt19937_64 r(1); std::uniform_real_distribution<double> u(-1,1);
  const std::size_t n=20000, v=4*n; std::vector<point<double>> a(v),b(v); std::vector<vertex_face_indices> ix(n);
  for(std::size_t i=0;i<v;++i){a[i]={u(r),u(r),u(r)};b[i]={u(r),u(r),u(r)};}
  for(index i=0;i<n;++i) ix[i]={4*i,4*i+1,4*i+2,4*i+3};
  const double* pa=&a[0].x,*pb=&b[0].x;
  positions p(coordinates<double>::rows(pa),coordinates<double>::rows(pb),v);
  auto c=candidates<vertex_face_indices>::rows(ix.data(),n);
  arena count; exact_memory m0(count,v,n); std::vector<std::byte> mem(count.used()+256);
  arena ar(mem.data(),mem.size()); exact_memory m(ar,v,n);
  host_launcher h; std::vector<outcome> ans(n);
  run_exact(h,p,c,ans.data(),m);
  std::size_t bad=0,col=0; for(std::size_t i=0;i<n;++i){ auto q=query_at<double>(p,ix[i]); auto w=decide(method::exact,q).outcome; bad+=w!=ans[i]; col+=w==outcome::collides;}
  printf("%zu bad of %zu, %zu collide; counters %u %u %u %u %u %u\n",bad,n,col,m.counters->coplanarity,m.counters->inside,m.counters->subdivision,m.counters->one_word,m.counters->two_words,m.counters->left);
  auto test=[&](auto method_tag, auto real, method mm){ using M=decltype(method_tag); using T=decltype(real);
    arena ar2(mem.data(),mem.size()); method_memory mm2(ar2,n); run_method<M,T>(h,p,c,ans.data(),mm2);
    std::size_t diff=0,wrong=0,unc=0; for(std::size_t i=0;i<n;++i){ auto q=query_at<double>(p,ix[i]); auto w=decide(mm,q).outcome; auto e=decide(method::exact,q).outcome; diff+=w!=ans[i]; unc+=ans[i]==outcome::uncertain; wrong+= ans[i]!=outcome::uncertain&&ans[i]!=e;}
    printf("diff %zu wrong %zu uncertain %zu roots %u in doubles %u\n",diff,wrong,unc,mm2.counters->roots,mm2.counters->in_doubles); };
  test(bsc_method<errbound::tight>{},1.0,method::tight);
  test(bsc_method<errbound::tight>{},1.0f,method::tight);
  test(bsc_method<errbound::safe>{},1.0f,method::safe);
  test(bsc_method<errbound::none>{},1.0f,method::float_);
  test(safeccd_method<errbound::safe>{},1.0,method::safeccd);
  test(safeccd_method<errbound::safe>{},1.0f,method::safeccd);
  test(safeccd_method<errbound::tight>{},1.0f,method::safeccd_tight);
}
